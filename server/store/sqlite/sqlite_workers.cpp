// SPDX-License-Identifier: Apache-2.0
// The SQLite store for workers: tasks are claimed, and settled or given back.
#include <algorithm>

#include "server/store/sql_values.h"
#include "server/store/sqlite/sqlite_jobs.h"

namespace weft::server {

using sqlite::Blob;
using sqlite::Rows;
using sqlite::Transaction;

namespace {

// Of the oldest due tasks of all owners but some, the one of the owner whose turn it is.
constexpr std::string_view kNextTask = R"sql(
SELECT first FROM (
  SELECT owner, min(id) AS first FROM task WHERE state = 0 AND due <= ?1 AND weight <= ?2
  GROUP BY owner) AS candidate
WHERE instr(?3, ',' || lower(hex(owner)) || ',') = 0
ORDER BY (SELECT count(*) FROM task WHERE task.state = 1 AND task.owner = candidate.owner),
         (SELECT coalesce(max(turn), 0) FROM served WHERE served.owner = candidate.owner),
         first
LIMIT 1)sql";

bool holds(Transaction& transaction, const ClaimRef& claim) {
  return transaction
      .run("SELECT 1 FROM task WHERE id = ?1 AND attempt = ?2 AND state = 1", claim.task,
           claim.attempt)
      .next();
}

// Whether it was this claim that ended the task in this state.
bool has_settled(Transaction& transaction, const ClaimRef& claim, JobState state) {
  return transaction
      .run("SELECT 1 FROM settled WHERE task = ?1 AND attempt = ?2 AND state = ?3", claim.task,
           claim.attempt, static_cast<int>(state))
      .next();
}

// Ends the task of a claim that holds it, and all its jobs.
void settle(Transaction& transaction, const ClaimRef& claim, JobState state,
            const std::string& error, WallTime now) {
  settle_jobs(transaction, claim.task, "", state, error, now);
  transaction.change("DELETE FROM task WHERE id = ?1", claim.task);
  transaction.change("INSERT INTO settled (task, attempt, state, at) VALUES (?1, ?2, ?3, ?4)",
                     claim.task, claim.attempt, static_cast<int>(state), to_micros(now));
}

// False if a chunk is missing.
bool insert_mesh(Transaction& transaction, std::int64_t task, const std::string& key,
                 const StoredMesh& mesh, WallTime now) {
  transaction.change("DELETE FROM mesh WHERE key = ?1", Blob{key});
  std::int64_t id = 0;
  {
    Rows rows = transaction.run(
        "INSERT INTO mesh (key, asked, brief, owner) SELECT ?2, ?3, ?4, owner FROM task "
        "WHERE id = ?1 RETURNING id",
        task, Blob{key}, to_micros(now), Blob{mesh.brief});
    if (rows.next()) id = rows.integer(0);
  }
  transaction.change("INSERT INTO mesh_summary (mesh, bytes) VALUES (?1, ?2)", id,
                     Blob{mesh.summary});
  std::int64_t place = 0;
  for (const StoredChunk& chunk : mesh.chunks) {
    const std::int64_t inserted = transaction.change(
        "INSERT INTO mesh_chunk (mesh, place, chunk) SELECT ?1, ?2, id FROM chunk WHERE sha256 = "
        "?3",
        id, place++, Blob{chunk.sha256});
    if (inserted == 0) return false;
  }
  return true;
}

// The chunk's row, if there is one, which then counts as put now.
std::optional<std::int64_t> touch_chunk(Transaction& transaction, const std::string& sha256,
                                        std::int64_t now) {
  Rows rows = transaction.run("UPDATE chunk SET touched = ?2 WHERE sha256 = ?1 RETURNING id",
                              Blob{sha256}, now);
  if (!rows.next()) return std::nullopt;
  return rows.integer(0);
}

}  // namespace

StoreResult<std::optional<Claim>> SqliteJobs::claim(const std::string& worker,
                                                    std::chrono::milliseconds lease,
                                                    std::uint64_t max_estimate,
                                                    const std::vector<std::string>& except) {
  return core_->write(Durability::kLater, [&](Transaction& transaction) {
    std::optional<Claim> claim;
    const std::int64_t now = to_micros(core_->now());
    std::optional<std::int64_t> task;
    {
      const std::string excluded = list_of(except);
      Rows rows = transaction.run(kNextTask, now, to_sql(max_estimate), excluded);
      if (rows.next()) task = rows.integer(0);
    }
    if (!task) return claim;
    Rows rows = transaction.run(
        "UPDATE task SET state = 1, attempt = attempt + 1, tries = tries + 1, worker = ?2, "
        "started = coalesce(started, ?3), lease_end = ?3 + ?4 WHERE id = ?1 "
        "RETURNING attempt, key, owner, weight, job, trace, tries, "
        "(SELECT request FROM task_request WHERE task = ?1)",
        *task, worker, now, to_micros(lease));
    if (!rows.next()) return claim;
    claim.emplace();
    claim->ref = {*task, static_cast<std::uint32_t>(rows.integer(0))};
    claim->key = rows.bytes(1);
    claim->owner = rows.bytes(2);
    claim->estimate = to_unsigned(rows.integer(3));
    claim->job_id = rows.bytes(4);
    claim->trace = rows.bytes(5);
    claim->tries = static_cast<std::uint32_t>(rows.integer(6));
    claim->request = rows.bytes(7);
    transaction.change(
        "INSERT OR REPLACE INTO served (owner, turn) "
        "VALUES (?1, (SELECT coalesce(max(turn), 0) + 1 FROM served))",
        claim->owner);
    return claim;
  });
}

StoreResult<Held> SqliteJobs::renew(const ClaimRef& claim, std::chrono::milliseconds lease,
                                    const std::string& progress) {
  return core_->write(Durability::kLater, [&](Transaction& transaction) {
    const std::int64_t renewed = transaction.change(
        "UPDATE task SET lease_end = ?3, progress = ?4 WHERE id = ?1 AND attempt = ?2 AND state = "
        "1",
        claim.task, claim.attempt, to_micros(core_->now()) + to_micros(lease), Blob{progress});
    return renewed == 1 ? Held::kHeld : Held::kLost;
  });
}

StoreResult<bool> SqliteJobs::put_chunk(const std::string& sha256, std::string_view bytes) {
  return core_->write_quietly(Durability::kLater, [&](Transaction& transaction) {
    const std::int64_t now = to_micros(core_->now());
    if (const auto there = touch_chunk(transaction, sha256, now)) {
      if (transaction.blob("chunk_bytes", "bytes", *there) == bytes) return false;
      transaction.change("UPDATE chunk SET size = ?2 WHERE id = ?1", *there, to_sql(bytes.size()));
      transaction.change("UPDATE chunk_bytes SET bytes = ?2 WHERE chunk = ?1", *there, Blob{bytes});
      return true;
    }
    std::int64_t id = 0;
    {
      Rows rows = transaction.run(
          "INSERT INTO chunk (sha256, size, touched) VALUES (?1, ?2, ?3) RETURNING id",
          Blob{sha256}, to_sql(bytes.size()), now);
      if (rows.next()) id = rows.integer(0);
    }
    transaction.change("INSERT INTO chunk_bytes (chunk, bytes) VALUES (?1, ?2)", id, Blob{bytes});
    return false;
  });
}

StoreResult<Held> SqliteJobs::finish(const ClaimRef& claim, const StoredMesh& mesh) {
  return core_->write(Durability::kWait, [&](Transaction& transaction) {
    if (!holds(transaction, claim)) {
      return has_settled(transaction, claim, JobState::kSucceeded) ? Held::kHeld : Held::kLost;
    }
    const WallTime now = core_->now();
    std::string key;
    {
      Rows rows = transaction.run("SELECT key FROM task WHERE id = ?1", claim.task);
      if (rows.next()) key = rows.bytes(0);
    }
    if (!insert_mesh(transaction, claim.task, key, mesh, now)) {
      transaction.fail({StoreErrorKind::kUnavailable, "a chunk of the mesh is not in the store"});
      return Held::kHeld;
    }
    settle(transaction, claim, JobState::kSucceeded, "", now);
    return Held::kHeld;
  });
}

StoreResult<Held> SqliteJobs::fail(const ClaimRef& claim, const std::string& error) {
  return core_->write(Durability::kWait, [&](Transaction& transaction) {
    if (!holds(transaction, claim)) {
      return has_settled(transaction, claim, JobState::kFailed) ? Held::kHeld : Held::kLost;
    }
    settle(transaction, claim, JobState::kFailed, error, core_->now());
    return Held::kHeld;
  });
}

StoreResult<Held> SqliteJobs::release(const ClaimRef& claim, std::chrono::milliseconds delay,
                                      bool counts) {
  return core_->write(Durability::kLater, [&](Transaction& transaction) {
    const std::int64_t released = transaction.change(
        "UPDATE task SET state = 0, due = ?3, lease_end = NULL, progress = x'', "
        "tries = tries - ?4, started = CASE WHEN tries > ?4 THEN started END "
        "WHERE id = ?1 AND attempt = ?2 AND state = 1",
        claim.task, claim.attempt,
        to_micros(core_->now()) + to_micros(std::min(delay, kLongestDelay)), counts ? 0 : 1);
    return released == 1 ? Held::kHeld : Held::kLost;
  });
}

}  // namespace weft::server
