// SPDX-License-Identifier: Apache-2.0
// The base of every function of the PostgreSQL store: the connections, retries when one breaks, and
// notifications of changes.
//
// Thread-safety: every function may be called from any thread.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "server/store/postgres/postgres.h"
#include "server/store/postgres/postgres_listener.h"
#include "server/store/postgres/postgres_store.h"

namespace weft::server {

// Whether a call may be repeated if its outcome is unknown.
enum class Repeat { kNever, kWhenUnclear };

class PostgresCore {
 public:
  static StoreResult<std::unique_ptr<PostgresCore>> open(PostgresStore::Options options);

  // Runs `body(transaction)` and commits; its result is valid only then. It may run twice: again if
  // the first run had no effect, and with Repeat::kWhenUnclear also if it may have had one. If
  // `body` has called `announce(transaction)`, the listeners of all servers are notified.
  template <class Body>
  auto run(postgres::Begin begin, Repeat repeat, const Body& body) {
    using Value = decltype(body(std::declval<postgres::Transaction&>()));
    StoreResult<Value> result = tl::unexpected(StoreError{});
    for (int attempt = 0; attempt < 2; ++attempt) {
      Lease lease(*this);
      if (!lease.connection) return StoreResult<Value>(tl::unexpected(lease.error));
      postgres::Transaction transaction(*lease.connection, begin);
      Value value = body(transaction);
      const StoreResult<void> done = transaction.commit();
      if (done) {
        if (transaction.notifies()) listener_.call();
        return StoreResult<Value>(std::move(value));
      }
      result = tl::unexpected(done.error());
      if (!transaction.may_succeed_again()) break;
      if (transaction.ambiguous() && repeat == Repeat::kNever) break;
    }
    return result;
  }

  void announce(postgres::Transaction& transaction) const {
    transaction.notify(PostgresListener::kChannel, listener_.name());
  }

  void on_change(std::function<void()> listener) { listener_.set(std::move(listener)); }

 private:
  // Lends a connection while it lives.
  struct Lease {
    explicit Lease(PostgresCore& from);
    ~Lease();
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;

    PostgresCore& core;
    std::unique_ptr<postgres::Connection> connection;  // null if none is available
    StoreError error;
  };

  PostgresCore(postgres::Connection::Options connecting, std::size_t connections,
               std::unique_ptr<postgres::Connection> first,
               std::unique_ptr<postgres::Connection> listening);

  const postgres::Connection::Options connecting_;

  std::mutex mutex_;  // guards the two below
  std::condition_variable returned_;
  std::size_t free_;  // how many more may be lent
  std::vector<std::unique_ptr<postgres::Connection>> idle_;

  PostgresListener listener_;
};

}  // namespace weft::server
