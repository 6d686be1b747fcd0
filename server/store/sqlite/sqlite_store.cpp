// SPDX-License-Identifier: Apache-2.0
#include "server/store/sqlite/sqlite_store.h"

#include <utility>

#include "server/store/sqlite/sqlite_core.h"
#include "server/store/sqlite/sqlite_jobs.h"

namespace weft::server {

StoreResult<std::unique_ptr<JobStore>> SqliteStore::open(Options options) {
  auto core = SqliteCore::open(std::move(options));
  if (!core) return tl::unexpected(core.error());
  // Leases belong to the server that ran before this one and is gone, so nobody waits for their
  // end.
  const auto expired = (*core)->write(Durability::kLater, [](sqlite::Transaction& transaction) {
    transaction.change(
        "UPDATE job SET callback_due = 0 WHERE callback_due IS NOT NULL AND "
        "callback_state = ?1",
        static_cast<int>(CallbackState::kClaimed));
    return transaction.change("UPDATE task SET lease_end = 0 WHERE lease_end IS NOT NULL");
  });
  if (!expired) return tl::unexpected(expired.error());
  return std::make_unique<SqliteJobs>(std::move(*core));
}

}  // namespace weft::server
