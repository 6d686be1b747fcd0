// SPDX-License-Identifier: Apache-2.0
// The PostgreSQL store for workers: tasks are claimed, and settled or given back.
#include <algorithm>

#include "server/store/postgres/postgres_jobs.h"
#include "server/store/sql_values.h"

namespace weft::server {

using postgres::Begin;
using postgres::Blob;
using postgres::Rows;
using postgres::Transaction;

namespace {

constexpr std::size_t kDigestBytes = 32;

// The oldest due task of the owner whose turn it is; if another server is just taking that one, the
// next. Owners come in order, and the search ends at the first task that is found, so no other task
// is locked.
constexpr const char* kClaim = R"sql(
WITH owner_of_due AS (
  SELECT owner FROM (
    SELECT owner, min(id) AS oldest FROM weft_task
    WHERE state = 0 AND due <= now() AND weight <= $3 GROUP BY owner) AS due
  WHERE strpos($4, ',' || encode(convert_to(owner, 'UTF8'), 'hex') || ',') = 0
  ORDER BY (SELECT count(*) FROM weft_task AS running
            WHERE running.state = 1 AND running.owner = due.owner),
           (SELECT coalesce(max(turn), 0) FROM weft_served WHERE weft_served.owner = due.owner),
           oldest
), next AS (
  SELECT task.id FROM owner_of_due CROSS JOIN LATERAL (
    SELECT id FROM weft_task WHERE weft_task.owner = owner_of_due.owner
    AND state = 0 AND due <= now() AND weight <= $3
    ORDER BY id LIMIT 1 FOR UPDATE SKIP LOCKED) AS task
  LIMIT 1
), claimed AS (
  UPDATE weft_task AS task
  SET state = 1, attempt = attempt + 1, tries = tries + 1, worker = $1,
      started = coalesce(started, clock_timestamp()),
      lease_end = clock_timestamp() + $2 * interval '1 microsecond'
  FROM next WHERE task.id = next.id
  RETURNING task.id, attempt, key, owner, weight, job, trace, tries, request
), served AS (
  INSERT INTO weft_served (owner, turn) SELECT owner, nextval('weft_turn') FROM claimed
  ON CONFLICT (owner) DO UPDATE SET turn = excluded.turn
)
SELECT id, attempt, key, owner, weight, job, trace, tries, request FROM claimed)sql";

// The key of the task that the claim holds; nobody else changes the task from then on.
std::optional<std::string> lock_held(Transaction& transaction, const ClaimRef& claim) {
  Rows rows = transaction.run(
      "SELECT key FROM weft_task WHERE id = $1 AND attempt = $2 AND state = 1 FOR UPDATE",
      claim.task, claim.attempt);
  if (!rows.next()) return std::nullopt;
  return rows.bytes(0);
}

// Whether it was this claim that ended the task in this state.
bool has_settled(Transaction& transaction, const ClaimRef& claim, JobState state) {
  return transaction
      .run("SELECT 1 FROM weft_settled WHERE task = $1 AND attempt = $2 AND state = $3", claim.task,
           claim.attempt, static_cast<int>(state))
      .next();
}

// Ends a task that is locked, and all its jobs.
void settle(Transaction& transaction, const ClaimRef& claim, JobState state,
            const std::string& error) {
  settle_jobs(transaction, claim.task, "", state, error);
  transaction.change("DELETE FROM weft_task WHERE id = $1", claim.task);
  transaction.change("INSERT INTO weft_settled (task, attempt, state) VALUES ($1, $2, $3)",
                     claim.task, claim.attempt, static_cast<int>(state));
}

// False if a chunk is missing.
bool insert_mesh(Transaction& transaction, std::int64_t task, const std::string& key,
                 const StoredMesh& mesh) {
  std::string digests;
  for (const StoredChunk& chunk : mesh.chunks) {
    if (chunk.sha256.size() != kDigestBytes) return false;
    digests += chunk.sha256;
  }
  std::int64_t id = 0;
  {
    Rows rows = transaction.run(
        "INSERT INTO weft_mesh (key, summary, brief, owner) SELECT $2, $3, $4, owner "
        "FROM weft_task WHERE id = $1 ON CONFLICT (key) DO UPDATE SET summary = excluded.summary, "
        "brief = excluded.brief, owner = excluded.owner, asked = clock_timestamp() RETURNING id",
        task, Blob{key}, Blob{mesh.summary}, Blob{mesh.brief});
    if (rows.next()) id = rows.integer(0);
  }
  transaction.change("DELETE FROM weft_mesh_chunk WHERE mesh = $1", id);
  const auto count = static_cast<std::int64_t>(mesh.chunks.size());
  const std::int64_t inserted = transaction.change(
      "INSERT INTO weft_mesh_chunk (mesh, place, chunk) "
      "SELECT $1, place, sha256 FROM generate_series(0, $3 - 1) AS place "
      "JOIN weft_chunk ON sha256 = substring($2 FROM (32 * place + 1)::int FOR 32)",
      id, Blob{digests}, count);
  return inserted == count;
}

}  // namespace

StoreResult<std::optional<Claim>> PostgresJobs::claim(const std::string& worker,
                                                      std::chrono::milliseconds lease,
                                                      std::uint64_t max_estimate,
                                                      const std::vector<std::string>& except) {
  // Durable, because an attempt that a crash of the database forgets would be given twice. Not
  // repeated if the outcome is unclear: the lease of a task that nobody knows of runs out by
  // itself.
  return core_->run(Begin::kDurable, Repeat::kNever, [&](Transaction& transaction) {
    std::optional<Claim> claim;
    const std::string excluded = list_of(except);
    Rows rows = transaction.run(kClaim, worker, to_micros(lease), to_sql(max_estimate), excluded);
    if (!rows.next()) return claim;
    claim.emplace();
    claim->ref = {rows.integer(0), static_cast<std::uint32_t>(rows.integer(1))};
    claim->key = rows.bytes(2);
    claim->owner = rows.bytes(3);
    claim->estimate = to_unsigned(rows.integer(4));
    claim->job_id = rows.bytes(5);
    claim->trace = rows.bytes(6);
    claim->tries = static_cast<std::uint32_t>(rows.integer(7));
    claim->request = rows.bytes(8);
    core_->announce(transaction);
    return claim;
  });
}

StoreResult<Held> PostgresJobs::renew(const ClaimRef& claim, std::chrono::milliseconds lease,
                                      const std::string& progress) {
  return core_->run(Begin::kLater, Repeat::kWhenUnclear, [&](Transaction& transaction) {
    const std::int64_t renewed = transaction.change(
        "UPDATE weft_task SET lease_end = clock_timestamp() + $3 * interval '1 microsecond', "
        "progress = $4 WHERE id = $1 AND attempt = $2 AND state = 1",
        claim.task, claim.attempt, to_micros(lease), Blob{progress});
    if (renewed == 0) return Held::kLost;
    core_->announce(transaction);
    return Held::kHeld;
  });
}

StoreResult<bool> PostgresJobs::put_chunk(const std::string& sha256, std::string_view bytes) {
  return core_->run(Begin::kLater, Repeat::kWhenUnclear, [&](Transaction& transaction) {
    // If the chunk is there already, it is not sent.
    std::optional<bool> sound;
    {
      Rows rows = transaction.run(
          "UPDATE weft_chunk SET touched = clock_timestamp() WHERE sha256 = $1 "
          "RETURNING sha256(bytes) = sha256",
          Blob{sha256});
      if (rows.next()) sound = rows.integer(0) != 0;
    }
    if (sound == true) return false;
    transaction.change(
        "INSERT INTO weft_chunk (sha256, size, bytes) VALUES ($1, $2, $3) "
        "ON CONFLICT (sha256) DO UPDATE SET touched = clock_timestamp(), size = excluded.size, "
        "bytes = excluded.bytes WHERE sha256(weft_chunk.bytes) <> weft_chunk.sha256",
        Blob{sha256}, to_sql(bytes.size()), Blob{bytes});
    return sound == false;
  });
}

StoreResult<Held> PostgresJobs::finish(const ClaimRef& claim, const StoredMesh& mesh) {
  return core_->run(Begin::kDurable, Repeat::kWhenUnclear, [&](Transaction& transaction) {
    const std::optional<std::string> key = lock_held(transaction, claim);
    if (!key) {
      return has_settled(transaction, claim, JobState::kSucceeded) ? Held::kHeld : Held::kLost;
    }
    if (!insert_mesh(transaction, claim.task, *key, mesh)) {
      transaction.fail({StoreErrorKind::kUnavailable, "a chunk of the mesh is not in the store"});
      return Held::kHeld;
    }
    settle(transaction, claim, JobState::kSucceeded, "");
    core_->announce(transaction);
    return Held::kHeld;
  });
}

StoreResult<Held> PostgresJobs::fail(const ClaimRef& claim, const std::string& error) {
  return core_->run(Begin::kDurable, Repeat::kWhenUnclear, [&](Transaction& transaction) {
    if (!lock_held(transaction, claim)) {
      return has_settled(transaction, claim, JobState::kFailed) ? Held::kHeld : Held::kLost;
    }
    settle(transaction, claim, JobState::kFailed, error);
    core_->announce(transaction);
    return Held::kHeld;
  });
}

StoreResult<Held> PostgresJobs::release(const ClaimRef& claim, std::chrono::milliseconds delay,
                                        bool counts) {
  return core_->run(Begin::kLater, Repeat::kNever, [&](Transaction& transaction) {
    const std::int64_t released = transaction.change(
        "UPDATE weft_task SET state = 0, due = clock_timestamp() + $3 * interval '1 microsecond', "
        "lease_end = NULL, progress = '', tries = tries - $4, "
        "started = CASE WHEN tries > $4 THEN started END "
        "WHERE id = $1 AND attempt = $2 AND state = 1",
        claim.task, claim.attempt, to_micros(std::min(delay, kLongestDelay)), counts ? 0 : 1);
    if (released == 0) return Held::kLost;
    core_->announce(transaction);
    return Held::kHeld;
  });
}

}  // namespace weft::server
