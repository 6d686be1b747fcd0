// SPDX-License-Identifier: Apache-2.0
#include "server/store/postgres/postgres_core.h"

#include <utility>

#include "server/store/postgres/postgres_schema.h"

namespace weft::server {

StoreResult<std::unique_ptr<PostgresCore>> PostgresCore::open(PostgresStore::Options options) {
  const postgres::Connection::Options connecting{std::move(options.uri), options.connect_timeout,
                                                 options.statement_timeout};
  auto first = postgres::Connection::open(connecting);
  if (!first) return tl::unexpected(first.error());
  if (const auto done = migrate(**first); !done) return tl::unexpected(done.error());
  auto listening = PostgresListener::connect(connecting);
  if (!listening) return tl::unexpected(listening.error());
  return std::unique_ptr<PostgresCore>(
      new PostgresCore(connecting, options.connections, std::move(*first), std::move(*listening)));
}

PostgresCore::PostgresCore(postgres::Connection::Options connecting, std::size_t connections,
                           std::unique_ptr<postgres::Connection> first,
                           std::unique_ptr<postgres::Connection> listening)
    : connecting_(std::move(connecting)),
      free_(connections),
      listener_(connecting_, std::move(listening)) {
  idle_.push_back(std::move(first));
}

PostgresCore::Lease::Lease(PostgresCore& from) : core(from) {
  {
    std::unique_lock lock(core.mutex_);
    if (!core.returned_.wait_for(lock, core.connecting_.statement_timeout,
                                 [&] { return core.free_ > 0; })) {
      error.message = "PostgreSQL: all connections are busy";
      return;
    }
    --core.free_;
    if (!core.idle_.empty()) {
      connection = std::move(core.idle_.back());
      core.idle_.pop_back();
      return;
    }
  }
  auto opened = postgres::Connection::open(core.connecting_);
  if (opened) {
    connection = std::move(*opened);
  } else {
    error = opened.error();
    const std::lock_guard lock(core.mutex_);
    ++core.free_;
    core.returned_.notify_one();
  }
}

PostgresCore::Lease::~Lease() {
  if (!connection) return;
  std::vector<std::unique_ptr<postgres::Connection>> useless;  // closed after the mutex is free
  {
    const std::lock_guard lock(core.mutex_);
    ++core.free_;
    if (connection->broken()) {
      // The other idle connections go to the same server, so most likely they were closed, too.
      useless.swap(core.idle_);
      useless.push_back(std::move(connection));
    } else {
      core.idle_.push_back(std::move(connection));
    }
  }
  core.returned_.notify_one();
}

}  // namespace weft::server
