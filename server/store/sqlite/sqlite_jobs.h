// SPDX-License-Identifier: Apache-2.0
// The functions of the SQLite store: for clients in sqlite_clients.cpp, for workers in
// sqlite_workers.cpp, for callbacks in sqlite_callbacks.cpp, for the house-keeping in
// sqlite_garbage_collection.cpp.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "server/store/job_id.h"
#include "server/store/job_store.h"
#include "server/store/sqlite/sqlite_core.h"

namespace weft::server {

class SqliteJobs final : public JobStore {
 public:
  explicit SqliteJobs(std::unique_ptr<SqliteCore> core) : core_(std::move(core)) {}

  StoreResult<Submitted> submit(const Submission& submission) override;
  StoreResult<std::optional<JobRecord>> get(const std::string& owner,
                                            const std::string& id) override;
  StoreResult<std::vector<JobRecord>> list(const ListQuery& query) override;
  StoreResult<std::optional<JobRecord>> cancel(const std::string& owner,
                                               const std::string& id) override;
  StoreResult<std::optional<JobRecord>> remove(const std::string& owner,
                                               const std::string& id) override;
  StoreResult<std::optional<StoredMesh>> mesh(const std::string& key) override;
  StoreResult<std::optional<std::string>> chunk(const std::string& sha256) override;
  StoreResult<std::uint64_t> drop_damaged(const std::string& sha256,
                                          std::string_view bytes) override;

  StoreResult<std::optional<Claim>> claim(const std::string& worker,
                                          std::chrono::milliseconds lease,
                                          std::uint64_t max_estimate,
                                          const std::vector<std::string>& except) override;
  StoreResult<Held> renew(const ClaimRef& claim, std::chrono::milliseconds lease,
                          const std::string& progress) override;
  StoreResult<bool> put_chunk(const std::string& sha256, std::string_view bytes) override;
  StoreResult<Held> finish(const ClaimRef& claim, const StoredMesh& mesh) override;
  StoreResult<Held> fail(const ClaimRef& claim, const std::string& error) override;
  StoreResult<Held> release(const ClaimRef& claim, std::chrono::milliseconds delay,
                            bool counts) override;

  StoreResult<std::optional<JobRecord>> claim_callback(
      std::chrono::milliseconds lease, const std::vector<std::string>& except_owners,
      const std::vector<std::string>& except_places) override;
  StoreResult<Held> settle_callback(const JobRecord& claimed, CallbackState state,
                                    const std::string& error,
                                    std::chrono::milliseconds delay) override;

  StoreResult<Reaped> reap(const RetryPolicy& policy) override;
  StoreResult<Collected> collect(const KeepPolicy& policy) override;
  StoreResult<StoreStats> stats() override;

  void on_change(std::function<void()> listener) override { core_->on_change(std::move(listener)); }

 private:
  Submitted submit_in(sqlite::Transaction& transaction, const Submission& submission,
                      const JobRecord& fresh);

  const std::unique_ptr<SqliteCore> core_;
  JobIds ids_;
};

// --- shared ---

// Returns the job `id`; nullopt if the owner has no such job.
std::optional<JobRecord> find_job(sqlite::Transaction& transaction, const std::string& owner,
                                  const std::string& id);

// Ends the jobs of a task, or only `job` if it is not empty; the task itself stays.
void settle_jobs(sqlite::Transaction& transaction, std::int64_t task, const std::string& job,
                 JobState state, const std::string& error, WallTime now);

}  // namespace weft::server
