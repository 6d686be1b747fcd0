// SPDX-License-Identifier: Apache-2.0
// Listens for changes that other servers make to a database, and calls a listener, on a thread and
// a connection of its own. If the connection breaks, it connects again, and then calls the
// listener, because it may have missed changes.
//
// Thread-safety: every function may be called from any thread.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "server/store/postgres/postgres.h"

namespace weft::server {

class PostgresListener {
 public:
  static constexpr const char* kChannel = "weft_change";

  // Opens a connection that listens.
  static StoreResult<std::unique_ptr<postgres::Connection>> connect(
      const postgres::Connection::Options& connecting);

  // `first` is such a connection; `connecting` has the options of later ones.
  PostgresListener(postgres::Connection::Options connecting,
                   std::unique_ptr<postgres::Connection> first);
  ~PostgresListener();
  PostgresListener(const PostgresListener&) = delete;
  PostgresListener& operator=(const PostgresListener&) = delete;

  // Sets the listener.
  void set(std::function<void()> told);
  // Calls the listener.
  void call();
  // The payload of this server's own notifications, which are ignored.
  const std::string& name() const { return name_; }

 private:
  void listen(std::unique_ptr<postgres::Connection> connection);
  // Listens until the connection breaks or the listener stops.
  void hear(postgres::Connection& connection);
  // Waits until `descriptor`, if it is valid, can be read, or the listener stops; at most for
  // `time`.
  void wait(int descriptor, std::chrono::milliseconds time) const;

  const postgres::Connection::Options connecting_;
  const std::string name_;
  const int stop_event_;
  std::atomic<bool> stopping_ = false;
  std::mutex mutex_;  // guards the one below
  std::function<void()> told_;
  std::thread thread_;  // destroyed first
};

}  // namespace weft::server
