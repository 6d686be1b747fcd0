// SPDX-License-Identifier: Apache-2.0
// A JobStore in a PostgreSQL database, for any number of servers that share it. Its tables begin
// with weft_, lie in the first schema of the search path, and are made at the first start.
//
// Clocks: all times are the database's.
//
// Fairness: claims one after another take exact turns; simultaneous claims do not wait for each
// other, and may each choose the same owner as the one with the fewest.
//
// Durability: commits wait for the disk, except those of `put_chunk`, `renew`, `release` and
// collection. A crash of the database may lose the last of these; `finish` waits for all that
// came before it, and fails if a chunk was lost: the mesh is then made again.
//
// If a connection breaks, a call is repeated once if that cannot have an effect twice, which
// holds for all calls except `claim`, `release` and `remove`. Those, and calls that fail again,
// return kUnavailable. If a submission without a request_id returns kUnavailable, it is unknown
// whether it was accepted: submitting again may give two jobs.
//
// No call waits for ever: see Options.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>

#include "server/store/job_store.h"

namespace weft::server {

class PostgresStore {
 public:
  struct Options {
    std::string uri;              // postgres://user@host/database, or a connection string of libpq
    std::size_t connections = 8;  // at once, and one more that listens
    std::chrono::seconds connect_timeout{5};
    // The time limit of a statement, of waiting for a connection, and of a transaction whose server
    // was stopped.
    std::chrono::milliseconds statement_timeout{30'000};
  };

  // kUnavailable if the database does not respond, kBroken if it has a newer version or
  // libpq cannot be loaded.
  static StoreResult<std::unique_ptr<JobStore>> open(Options options);
};

}  // namespace weft::server
