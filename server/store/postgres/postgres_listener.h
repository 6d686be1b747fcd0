// SPDX-License-Identifier: Apache-2.0
// Hears of the changes that other servers make to a database, and tells of them, on a thread and a
// connection of its own. When the connection breaks it comes back by itself, and then tells of a
// change, for there may have been some.
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

  // A connection that listens.
  static StoreResult<std::unique_ptr<postgres::Connection>> connect(
      const postgres::Connection::Options& connecting);

  // `first` is such a connection; `connecting` makes those that follow it.
  PostgresListener(postgres::Connection::Options connecting,
                   std::unique_ptr<postgres::Connection> first);
  ~PostgresListener();
  PostgresListener(const PostgresListener&) = delete;
  PostgresListener& operator=(const PostgresListener&) = delete;

  // Whom to tell.
  void set(std::function<void()> told);
  // Tells of a change.
  void call();
  // What this server's notifications carry: those that carry it are its own, and nothing new.
  const std::string& name() const { return name_; }

 private:
  void listen(std::unique_ptr<postgres::Connection> connection);
  // Until the connection breaks or the listener stops.
  void hear(postgres::Connection& connection);
  // Until `descriptor` can be read, where it is one, or the listener stops; at most so long.
  void wait(int descriptor, std::chrono::milliseconds time) const;

  const postgres::Connection::Options connecting_;
  const std::string name_;
  const int stop_event_;
  std::atomic<bool> stopping_ = false;
  std::mutex mutex_;  // guards the one below
  std::function<void()> told_;
  std::thread thread_;  // goes first
};

}  // namespace weft::server
