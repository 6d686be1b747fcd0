// SPDX-License-Identifier: Apache-2.0
// Turns SIGINT, SIGTERM and SIGHUP into a request to stop, so that destructors undo unfinished
// work. A second signal ends the process at once.
//
//   Signals signals;                      // before any other thread starts
//   int code = run(signals.stop());
//   if (signals.received()) signals.die();
#pragma once

#include <atomic>
#include <stop_token>
#include <thread>

#include "client/base/files.h"
#include "files/base/atomic_file.h"

namespace weft::client {

class Signals {
 public:
  // Blocks the signals in this thread and those that it starts. Ignores SIGPIPE and SIGXFSZ: writes
  // report these. One instance per process.
  Signals();
  ~Signals();
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  std::stop_token stop() const { return source_.get_token(); }
  // The first signal received; 0 if there was none.
  int received() const { return received_; }
  // Ends the process by the received signal. REQUIRES: received().
  [[noreturn]] void die();

 private:
  void watch();

  std::stop_source source_;
  std::atomic<int> received_{0};
  FileDescriptor signals_;
  FileDescriptor end_;
  std::thread watcher_;
};

}  // namespace weft::client
