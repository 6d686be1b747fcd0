// SPDX-License-Identifier: Apache-2.0
// Asks the server's own addresses whether they still answer, as a client would. A server whose
// listening socket is deaf otherwise looks well from within.
//
//   Probe probe({.addresses = {"127.0.0.1:7421"}, .lost = [](const std::string&) { _exit(5); }},
//   log);
//   ... probe.all_answer() ...
//
// An address answers if it takes a connection and sends anything, or ends it, within `patience`.
// After two failures in a row the log says `event=address_silent`, and `all_answer` is false until
// it answers again; after six, `lost` is called.
//
// Thread-safety: every function may be called from any thread; one thread asks.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "server/observe/log.h"

namespace weft::server {

struct ProbeOptions {
  std::vector<std::string> addresses{};  // HOST:PORT or unix:PATH
  bool encrypted = false;                // those of TCP
  std::chrono::milliseconds interval = std::chrono::seconds(10);
  std::chrono::milliseconds patience = std::chrono::seconds(5);
  // Called on the probe's thread, at most once.
  std::function<void(const std::string& address)> lost = [](const std::string&) {};
};

class Probe {
 public:
  static constexpr int kSilentAfter = 2;
  static constexpr int kLostAfter = 6;

  Probe(ProbeOptions options, Logger log);
  ~Probe() { stop(); }
  Probe(const Probe&) = delete;
  Probe& operator=(const Probe&) = delete;

  // Asks no more.
  void stop();

  bool all_answer() const { return silent_ == 0; }

 private:
  void ask_until_stopped();
  void ask_all();

  const ProbeOptions options_;
  const Logger log_;
  std::vector<int> failures_;   // in a row, of each address
  std::atomic<int> silent_{0};  // addresses
  bool lost_ = false;

  std::mutex mutex_;  // guards the one below
  bool stopping_ = false;
  std::condition_variable stopped_;
  std::thread thread_;
};

// Whether the address answers, see above. For 0.0.0.0 and [::], loopback is asked.
bool answers(const std::string& address, bool encrypted, std::chrono::milliseconds patience);

}  // namespace weft::server
