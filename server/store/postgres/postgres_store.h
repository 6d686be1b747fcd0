// SPDX-License-Identifier: Apache-2.0
// A JobStore in a PostgreSQL database, for any number of servers that share it. Its tables begin
// with weft_, lie in the first schema of the search path, and are made at the first start.
//
// Clocks: all times are the database's.
//
// Fairness: among claims that come one after another the turns are kept exactly; claims of the same
// moment do not wait for each other, and may each see an owner as the one with the fewest.
//
// Durability: commits wait for the disk, but for those of `put_chunk`, `renew`, `release` and what
// is collected. A crash of the database may forget the last of these; `finish` waits for all that
// came before it, and says so where a chunk was forgotten: the mesh is then made again.
//
// A connection that breaks: a call is tried once more where that cannot do anything twice, which
// holds for all calls but `claim`, `release` and `remove`. Those, and what fails again, answer
// kUnavailable. Of a submission without a request_id whose answer is kUnavailable nobody knows
// whether it was accepted: whoever submits again may have two jobs.
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
    // For a statement, for one that waits for its turn at the connections, and for a transaction
    // in which a server was stopped.
    std::chrono::milliseconds statement_timeout{30'000};
  };

  // kUnavailable if the database does not answer, kBroken if it is of a newer version.
  static StoreResult<std::unique_ptr<JobStore>> open(Options options);
};

}  // namespace weft::server
