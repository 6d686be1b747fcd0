// SPDX-License-Identifier: Apache-2.0
#include "server/store/postgres/postgres_store.h"

#include <utility>

#include "server/store/postgres/postgres_core.h"
#include "server/store/postgres/postgres_jobs.h"

namespace weft::server {

StoreResult<std::unique_ptr<JobStore>> PostgresStore::open(Options options) {
  auto core = PostgresCore::open(std::move(options));
  if (!core) return tl::unexpected(core.error());
  return std::make_unique<PostgresJobs>(std::move(*core));
}

}  // namespace weft::server
