// SPDX-License-Identifier: Apache-2.0
// Garbage collection of the PostgreSQL store: leases that ran out, what was kept too long, stats.
// Large deletions are done in steps. Servers that collect at the same time do not wait for each
// other.
#include "server/store/garbage_collection.h"
#include "server/store/postgres/postgres_jobs.h"
#include "server/store/sql_values.h"

namespace weft::server {

using postgres::Begin;
using postgres::Blob;
using postgres::Rows;
using postgres::Transaction;

namespace {

constexpr std::int64_t kCollectLock = 0x77656674'0003;

// The tasks are locked.
std::vector<LostTask> find_lost(Transaction& transaction, std::int64_t max_attempts) {
  std::vector<LostTask> lost;
  Rows rows = transaction.run(
      "SELECT id, tries FROM weft_task WHERE (state = 1 AND lease_end <= now()) "
      "OR (state = 0 AND tries > 0 AND tries >= $1) FOR UPDATE SKIP LOCKED",
      max_attempts);
  while (rows.next()) lost.push_back({rows.integer(0), rows.integer(1)});
  return lost;
}

// Times further ahead than any that is given now are those of a clock that was set back.
void shorten_times(Transaction& transaction, std::chrono::microseconds lease) {
  transaction.change(
      "UPDATE weft_task SET lease_end = now() + $1 * interval '1 microsecond' WHERE id IN "
      "(SELECT id FROM weft_task WHERE state = 1 AND lease_end > now() + $1 * interval "
      "'1 microsecond' FOR UPDATE SKIP LOCKED)",
      to_micros(lease));
  transaction.change(
      "UPDATE weft_task SET due = '-infinity' WHERE id IN (SELECT id FROM weft_task WHERE state = "
      "0 "
      "AND due > now() + $1 * interval '1 microsecond' FOR UPDATE SKIP LOCKED)",
      to_micros(kLongestDelay));
  transaction.change(
      "UPDATE weft_job SET callback_due = now() + $1 * interval '1 microsecond' WHERE id IN "
      "(SELECT id FROM weft_job WHERE callback_due > now() + $1 * interval '1 microsecond' "
      "AND ended IS NOT NULL FOR UPDATE SKIP LOCKED)",
      to_micros(kLongestCallbackDelay));
}

// Whether the oldest or the youngest task was made a second later than now, or more.
bool has_future_tasks(Transaction& transaction) {
  return transaction
      .run(
          "SELECT 1 FROM weft_task WHERE id IN ((SELECT min(id) FROM weft_task), "
          "(SELECT max(id) FROM weft_task)) AND created > clock_timestamp() + interval '1 second'")
      .next();
}

// Whether this transaction may collect. Only one can until it ends.
bool collects(Transaction& transaction) {
  Rows rows = transaction.run("SELECT pg_try_advisory_xact_lock($1)", kCollectLock);
  return rows.next() && rows.integer(0) != 0;
}

std::uint64_t delete_jobs(Transaction& transaction, std::int64_t age) {
  return to_unsigned(
      transaction.change("DELETE FROM weft_job WHERE id IN (SELECT id FROM weft_job "
                         "WHERE ended <= now() - $1 * interval '1 microsecond' "
                         "AND callback_due IS NULL LIMIT $2)",
                         age, kJobsAtOnce));
}

// Deletes some of the oldest ended jobs of an owner who has too many.
std::uint64_t delete_surplus_jobs(Transaction& transaction, std::int64_t most) {
  std::string owner;
  std::int64_t surplus = 0;
  {
    Rows rows = transaction.run(
        "SELECT owner, count(*) - $1 FROM weft_job WHERE ended IS NOT NULL AND callback_due IS "
        "NULL GROUP BY owner HAVING count(*) > $1 LIMIT 1",
        most);
    if (!rows.next()) return 0;
    owner = rows.bytes(0);
    surplus = rows.integer(1);
  }
  return to_unsigned(transaction.change(
      "DELETE FROM weft_job WHERE id IN (SELECT id FROM weft_job WHERE owner = $1 "
      "AND ended IS NOT NULL AND callback_due IS NULL ORDER BY id LIMIT $2)",
      owner, std::min<std::int64_t>(surplus, kJobsAtOnce)));
}

// Bytes of the chunks that belong to meshes.
std::int64_t bytes_of_meshes(Transaction& transaction) {
  Rows rows = transaction.run(
      "SELECT coalesce(sum(size), 0)::bigint FROM weft_chunk "
      "WHERE EXISTS (SELECT FROM weft_mesh_chunk WHERE chunk = sha256)");
  return rows.next() ? rows.integer(0) : 0;
}

// Bytes of the chunks that belong to this mesh and no other.
std::int64_t bytes_of_its_own(Transaction& transaction, std::int64_t mesh) {
  Rows rows = transaction.run(
      "SELECT coalesce(sum(size), 0)::bigint FROM weft_chunk "
      "WHERE sha256 IN (SELECT chunk FROM weft_mesh_chunk WHERE mesh = $1) "
      "AND NOT EXISTS (SELECT FROM weft_mesh_chunk WHERE chunk = sha256 AND mesh <> $1)",
      mesh);
  return rows.next() ? rows.integer(0) : 0;
}

struct OldMesh {
  std::int64_t id = 0;
  std::int64_t asked = 0;
  bool aged = false;
};

std::vector<OldMesh> find_oldest(Transaction& transaction, std::int64_t age) {
  std::vector<OldMesh> oldest;
  Rows rows = transaction.run(
      "SELECT id, weft_micros(asked), asked <= now() - $1 * interval '1 microsecond' "
      "FROM weft_mesh ORDER BY asked LIMIT $2",
      age, kMeshesAtOnce);
  while (rows.next()) oldest.push_back({rows.integer(0), rows.integer(1), rows.integer(2) != 0});
  return oldest;
}

// Deletes some of the meshes that nobody asked for since `age`, or that exceed `bytes`, the oldest
// first.
std::uint64_t delete_meshes(Transaction& transaction, std::int64_t age, std::int64_t bytes) {
  std::int64_t kept = bytes_of_meshes(transaction);
  std::uint64_t deleted = 0;
  for (const OldMesh& mesh : find_oldest(transaction, age)) {
    if (!mesh.aged && kept <= bytes) break;
    const std::int64_t own = bytes_of_its_own(transaction, mesh.id);
    // Not if somebody has just asked for it.
    const bool gone =
        transaction.change("DELETE FROM weft_mesh WHERE id = $1 AND weft_micros(asked) = $2",
                           mesh.id, mesh.asked) == 1;
    if (!gone) continue;
    kept -= own;
    ++deleted;
  }
  return deleted;
}

// Deletes some meshes of an owner whose meshes take more than `bytes`: those that were asked for
// longest ago.
std::uint64_t delete_surplus_meshes(Transaction& transaction, std::int64_t bytes) {
  std::string owner;
  std::int64_t surplus = 0;
  {
    Rows rows = transaction.run(
        "SELECT owner, (sum(size) - $1)::bigint FROM weft_mesh "
        "JOIN weft_mesh_chunk ON mesh = weft_mesh.id JOIN weft_chunk ON sha256 = chunk "
        "GROUP BY owner HAVING sum(size) > $1 LIMIT 1",
        bytes);
    if (!rows.next()) return 0;
    owner = rows.bytes(0);
    surplus = rows.integer(1);
  }
  struct Mesh {
    std::int64_t id = 0;
    std::int64_t asked = 0;
    std::int64_t bytes = 0;
  };
  std::vector<Mesh> oldest;
  {
    Rows rows = transaction.run(
        "SELECT id, weft_micros(asked), (SELECT coalesce(sum(size), 0)::bigint "
        "FROM weft_mesh_chunk JOIN weft_chunk ON sha256 = chunk WHERE mesh = weft_mesh.id) "
        "FROM weft_mesh WHERE owner = $1 ORDER BY asked LIMIT $2",
        owner, kMeshesAtOnce);
    while (rows.next()) oldest.push_back({rows.integer(0), rows.integer(1), rows.integer(2)});
  }
  std::uint64_t deleted = 0;
  for (const Mesh& mesh : oldest) {
    if (surplus <= 0) break;
    surplus -= mesh.bytes;
    // Not if somebody has just asked for it.
    deleted += to_unsigned(transaction.change(
        "DELETE FROM weft_mesh WHERE id = $1 AND weft_micros(asked) = $2", mesh.id, mesh.asked));
  }
  return deleted;
}

// Deletes some of the chunks that belong to no mesh and were not stored again since `age`.
Collected delete_loose_chunks(Transaction& transaction, std::int64_t age) {
  std::vector<std::pair<std::string, std::uint64_t>> loose;
  {
    // A chunk that `finish` is just adding to a mesh is locked.
    Rows rows = transaction.run(
        "SELECT sha256, size FROM weft_chunk "
        "WHERE touched <= now() - $1 * interval '1 microsecond' "
        "AND NOT EXISTS (SELECT FROM weft_mesh_chunk WHERE chunk = sha256) "
        "LIMIT $2 FOR UPDATE SKIP LOCKED",
        age, kChunksAtOnce);
    while (rows.next()) loose.emplace_back(rows.bytes(0), to_unsigned(rows.integer(1)));
  }
  Collected deleted;
  for (const auto& [sha256, size] : loose) {
    // Not if it was added to a mesh before it was locked here.
    const bool gone = transaction.change(
                          "DELETE FROM weft_chunk WHERE sha256 = $1 AND NOT EXISTS "
                          "(SELECT FROM weft_mesh_chunk WHERE chunk = $1)",
                          Blob{sha256}) == 1;
    if (!gone) continue;
    ++deleted.chunks;
    deleted.bytes += size;
  }
  return deleted;
}

// Nobody asks for the outcome of a task that ended an hour ago.
void forget_what_is_over(Transaction& transaction) {
  transaction.change("DELETE FROM weft_settled WHERE at <= now() - interval '1 hour'");
  transaction.change("DELETE FROM weft_served WHERE owner NOT IN (SELECT owner FROM weft_task)");
}

}  // namespace

StoreResult<Reaped> PostgresJobs::reap(const RetryPolicy& policy) {
  return core_->run(Begin::kDurable, Repeat::kWhenUnclear, [&](Transaction& transaction) {
    Reaped reaped;
    shorten_times(transaction, policy.longest_lease);
    reaped.clock_was_set_back = has_future_tasks(transaction);
    for (const LostTask& lost : find_lost(transaction, policy.max_attempts)) {
      if (lost.tries >= policy.max_attempts) {
        settle_jobs(transaction, lost.task, "", JobState::kFailed, policy.error);
        transaction.change("DELETE FROM weft_task WHERE id = $1", lost.task);
        ++reaped.failed;
      } else {
        transaction.change(
            "UPDATE weft_task SET state = 0, lease_end = NULL, progress = '', "
            "due = clock_timestamp() + $2 * interval '1 microsecond' WHERE id = $1",
            lost.task, to_micros(delay_after(policy, static_cast<std::uint32_t>(lost.tries))));
        ++reaped.requeued;
      }
    }
    if (reaped.failed + reaped.requeued != 0) core_->announce(transaction);
    return reaped;
  });
}

StoreResult<Collected> PostgresJobs::collect(const KeepPolicy& policy) {
  Collected all;
  const auto ended = collect_in_steps(all, [&] {
    return core_->run(Begin::kLater, Repeat::kNever, [&](Transaction& transaction) {
      Collected step;
      if (!collects(transaction)) return step;
      step.jobs = delete_jobs(transaction, to_micros(policy.age)) +
                  delete_surplus_jobs(transaction, to_sql(policy.jobs_of_owner));
      if (policy.share_of_owner < 1)
        step.meshes = delete_surplus_meshes(transaction, bytes_of_owner(policy));
      step.meshes += delete_meshes(transaction, to_micros(policy.age), to_sql(policy.bytes));
      if (step.jobs + step.meshes != 0) core_->announce(transaction);
      return step;
    });
  });
  if (!ended) return tl::unexpected(ended.error());
  const auto loose = collect_in_steps(all, [&] {
    return core_->run(Begin::kLater, Repeat::kNever, [&](Transaction& transaction) {
      return collects(transaction) ? delete_loose_chunks(transaction, to_micros(policy.loose_age))
                                   : Collected{};
    });
  });
  if (!loose) return tl::unexpected(loose.error());
  const auto forgotten = core_->run(Begin::kLater, Repeat::kNever, [&](Transaction& transaction) {
    if (collects(transaction)) forget_what_is_over(transaction);
    return true;
  });
  if (!forgotten) return tl::unexpected(forgotten.error());
  return all;
}

StoreResult<StoreStats> PostgresJobs::stats() {
  return core_->run(Begin::kOneStatement, Repeat::kWhenUnclear, [&](Transaction& transaction) {
    StoreStats stats;
    Rows rows = transaction.run(
        "SELECT count(*) FILTER (WHERE state = 0), count(*) FILTER (WHERE state = 1), "
        "least(coalesce(sum(weight) FILTER (WHERE state = 0), 0), 9223372036854775807)::bigint, "
        "coalesce(weft_micros(now()) - weft_micros(min(created) FILTER (WHERE state = 0)), 0), "
        "(SELECT count(*) FROM weft_mesh), "
        "(SELECT coalesce(sum(size), 0)::bigint FROM weft_chunk) FROM weft_task");
    if (rows.next()) {
      stats.queued = to_unsigned(rows.integer(0));
      stats.running = to_unsigned(rows.integer(1));
      stats.queued_estimate = to_unsigned(rows.integer(2));
      const std::int64_t waited = std::max<std::int64_t>(rows.integer(3), 0);
      stats.oldest_queued_seconds = 1e-6 * static_cast<double>(waited);
      stats.meshes = to_unsigned(rows.integer(4));
      stats.chunk_bytes = to_unsigned(rows.integer(5));
    }
    return stats;
  });
}

}  // namespace weft::server
