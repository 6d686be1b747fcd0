// SPDX-License-Identifier: Apache-2.0
#include "server/store/postgres/postgres_listener.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>

#include "server/store/job_id.h"

namespace weft::server {

using std::chrono::milliseconds;

namespace {

constexpr milliseconds kFirstPause{100};
constexpr milliseconds kLongestPause{5'000};
// Statements are sent this often, so that a server that vanished is noticed.
constexpr milliseconds kAliveInterval{10'000};

}  // namespace

StoreResult<std::unique_ptr<postgres::Connection>> PostgresListener::connect(
    const postgres::Connection::Options& connecting) {
  auto connection = postgres::Connection::open(connecting);
  if (!connection) return connection;
  const std::string listen = std::string("LISTEN ") + kChannel;
  if (const auto done = (*connection)->execute(listen.c_str()); !done) {
    return tl::unexpected(done.error());
  }
  return connection;
}

PostgresListener::PostgresListener(postgres::Connection::Options connecting,
                                   std::unique_ptr<postgres::Connection> first)
    : connecting_(std::move(connecting)),
      name_(JobIds().next(std::chrono::system_clock::now())),
      stop_event_(eventfd(0, EFD_CLOEXEC)),
      thread_([this, first = std::move(first)]() mutable { listen(std::move(first)); }) {}

PostgresListener::~PostgresListener() {
  stopping_ = true;
  eventfd_write(stop_event_, 1);
  thread_.join();
  close(stop_event_);
}

void PostgresListener::set(std::function<void()> told) {
  const std::lock_guard lock(mutex_);
  told_ = std::move(told);
}

void PostgresListener::call() {
  std::function<void()> told;
  {
    const std::lock_guard lock(mutex_);
    told = told_;
  }
  if (told) told();
}

void PostgresListener::listen(std::unique_ptr<postgres::Connection> connection) {
  milliseconds pause = kFirstPause;
  hear(*connection);
  while (!stopping_) {
    wait(-1, pause);
    auto next = connect(connecting_);
    if (!next) {
      pause = std::min(2 * pause, kLongestPause);
      continue;
    }
    pause = kFirstPause;
    connection = std::move(*next);
    call();
    hear(*connection);
  }
}

void PostgresListener::hear(postgres::Connection& connection) {
  while (!stopping_) {
    bool changed = false;
    while (const auto from = connection.next_notification()) changed |= *from != name_;
    if (changed) call();
    if (connection.broken()) return;
    const auto before = std::chrono::steady_clock::now();
    wait(connection.socket(), kAliveInterval);
    if (std::chrono::steady_clock::now() - before >= kAliveInterval &&
        !connection.execute("SELECT 1")) {
      return;
    }
  }
}

void PostgresListener::wait(int descriptor, milliseconds time) const {
  pollfd waits[2] = {{stop_event_, POLLIN, 0}, {descriptor, POLLIN, 0}};
  poll(waits, descriptor < 0 ? 1 : 2, static_cast<int>(time.count()));
}

}  // namespace weft::server
