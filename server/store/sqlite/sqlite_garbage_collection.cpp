// SPDX-License-Identifier: Apache-2.0
// Garbage collection of the SQLite store: leases that ran out, what was kept too long, stats.
// Large deletions are done in steps, so that others can write in between.
#include <algorithm>

#include "server/store/garbage_collection.h"
#include "server/store/sql_values.h"
#include "server/store/sqlite/sqlite_jobs.h"

namespace weft::server {

using sqlite::Rows;
using sqlite::Transaction;

namespace {

// Nobody asks for the outcome of a task that ended this long ago.
constexpr std::chrono::hours kSettledAge{1};

std::vector<LostTask> find_lost(Transaction& transaction, std::int64_t now,
                                std::int64_t max_attempts) {
  std::vector<LostTask> lost;
  Rows rows = transaction.run(
      "SELECT id, tries FROM task WHERE state = 1 AND lease_end <= ?1 "
      "UNION ALL SELECT id, tries FROM task WHERE state = 0 AND tries > 0 AND tries >= ?2",
      now, max_attempts);
  while (rows.next()) lost.push_back({rows.integer(0), rows.integer(1)});
  return lost;
}

// Times further ahead than any that is given now are those of a clock that was set back.
void shorten_times(Transaction& transaction, std::int64_t now, std::chrono::microseconds lease) {
  transaction.change("UPDATE task SET lease_end = ?1 WHERE state = 1 AND lease_end > ?1",
                     now + to_micros(lease));
  transaction.change("UPDATE task SET due = 0 WHERE state = 0 AND due > ?1",
                     now + to_micros(kLongestDelay));
  transaction.change(
      "UPDATE job SET callback_due = ?1 WHERE callback_due > ?1 AND ended IS NOT NULL",
      now + to_micros(kLongestCallbackDelay));
}

// Whether the oldest or the youngest task was made a second later than now, or more.
bool has_future_tasks(Transaction& transaction, std::int64_t now) {
  return transaction
      .run(
          "SELECT 1 FROM task WHERE id IN ((SELECT min(id) FROM task), (SELECT max(id) FROM task)) "
          "AND created > ?1 + 1000000",
          now)
      .next();
}

std::uint64_t delete_jobs(Transaction& transaction, std::int64_t ended) {
  return to_unsigned(transaction.change(
      "DELETE FROM job WHERE id IN (SELECT id FROM job WHERE ended <= ?1 AND callback_due IS NULL "
      "LIMIT ?2)",
      ended, kJobsAtOnce));
}

// Deletes some of the oldest ended jobs of an owner who has too many.
std::uint64_t delete_surplus_jobs(Transaction& transaction, std::int64_t most) {
  std::string owner;
  std::int64_t surplus = 0;
  {
    Rows rows = transaction.run(
        "SELECT owner, count(*) - ?1 FROM job WHERE ended IS NOT NULL AND callback_due IS NULL "
        "GROUP BY owner HAVING count(*) > ?1 LIMIT 1",
        most);
    if (!rows.next()) return 0;
    owner = rows.bytes(0);
    surplus = rows.integer(1);
  }
  return to_unsigned(transaction.change(
      "DELETE FROM job WHERE id IN (SELECT id FROM job WHERE owner = ?1 AND ended IS NOT NULL "
      "AND callback_due IS NULL ORDER BY id LIMIT ?2)",
      owner, std::min<std::int64_t>(surplus, kJobsAtOnce)));
}

void forget_what_is_over(Transaction& transaction, std::int64_t settled) {
  transaction.change("DELETE FROM settled WHERE at <= ?1", settled);
  transaction.change("DELETE FROM served WHERE owner NOT IN (SELECT owner FROM task)");
}

// Bytes of the chunks that belong to meshes.
std::int64_t bytes_of_meshes(Transaction& transaction) {
  Rows rows = transaction.run(
      "SELECT coalesce(sum(size), 0) FROM chunk WHERE id IN (SELECT chunk FROM mesh_chunk)");
  return rows.next() ? rows.integer(0) : 0;
}

// Bytes of the chunks that belong to this mesh and no other.
std::int64_t bytes_of_its_own(Transaction& transaction, std::int64_t mesh) {
  Rows rows = transaction.run(
      "SELECT coalesce(sum(size), 0) FROM chunk WHERE id IN "
      "(SELECT chunk FROM mesh_chunk WHERE mesh = ?1) AND NOT EXISTS "
      "(SELECT * FROM mesh_chunk WHERE mesh_chunk.chunk = chunk.id AND mesh <> ?1)",
      mesh);
  return rows.next() ? rows.integer(0) : 0;
}

// Deletes some of the meshes that nobody asked for since `asked`, or that exceed `bytes`, the
// oldest first.
std::uint64_t delete_meshes(Transaction& transaction, std::int64_t asked, std::int64_t bytes) {
  std::vector<std::pair<std::int64_t, std::int64_t>> oldest;  // id, when it was asked for
  {
    Rows rows =
        transaction.run("SELECT id, asked FROM mesh ORDER BY asked LIMIT ?1", kMeshesAtOnce);
    while (rows.next()) oldest.emplace_back(rows.integer(0), rows.integer(1));
  }
  std::int64_t kept = bytes_of_meshes(transaction);
  std::uint64_t deleted = 0;
  for (const auto& [mesh, last_asked] : oldest) {
    if (last_asked > asked && kept <= bytes) break;
    kept -= bytes_of_its_own(transaction, mesh);
    transaction.change("DELETE FROM mesh WHERE id = ?1", mesh);
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
        "SELECT owner, sum(size) - ?1 FROM mesh JOIN mesh_chunk ON mesh_chunk.mesh = mesh.id "
        "JOIN chunk ON chunk.id = mesh_chunk.chunk GROUP BY owner HAVING sum(size) > ?1 LIMIT 1",
        bytes);
    if (!rows.next()) return 0;
    owner = rows.bytes(0);
    surplus = rows.integer(1);
  }
  std::vector<std::pair<std::int64_t, std::int64_t>> oldest;  // id, bytes
  {
    Rows rows = transaction.run(
        "SELECT id, (SELECT coalesce(sum(size), 0) FROM mesh_chunk JOIN chunk ON chunk.id = "
        "mesh_chunk.chunk WHERE mesh_chunk.mesh = mesh.id) FROM mesh WHERE owner = ?1 "
        "ORDER BY asked LIMIT ?2",
        owner, kMeshesAtOnce);
    while (rows.next()) oldest.emplace_back(rows.integer(0), rows.integer(1));
  }
  std::uint64_t deleted = 0;
  for (const auto& [mesh, size] : oldest) {
    if (surplus <= 0) break;
    surplus -= size;
    transaction.change("DELETE FROM mesh WHERE id = ?1", mesh);
    ++deleted;
  }
  return deleted;
}

// Deletes some of the chunks that belong to no mesh and were not stored again since `touched`.
Collected delete_loose_chunks(Transaction& transaction, std::int64_t touched) {
  Collected deleted;
  std::vector<std::int64_t> loose;
  {
    Rows rows = transaction.run(
        "SELECT id, size FROM chunk WHERE touched <= ?1 AND NOT EXISTS "
        "(SELECT * FROM mesh_chunk WHERE mesh_chunk.chunk = chunk.id) LIMIT ?2",
        touched, kChunksAtOnce);
    while (rows.next()) {
      loose.push_back(rows.integer(0));
      deleted.bytes += to_unsigned(rows.integer(1));
    }
  }
  for (const std::int64_t chunk : loose) {
    transaction.change("DELETE FROM chunk WHERE id = ?1", chunk);
  }
  deleted.chunks = loose.size();
  return deleted;
}

}  // namespace

StoreResult<Reaped> SqliteJobs::reap(const RetryPolicy& policy) {
  return core_->write(Durability::kWait, [&](Transaction& transaction) {
    Reaped reaped;
    const WallTime now = core_->now();
    shorten_times(transaction, to_micros(now), policy.longest_lease);
    reaped.clock_was_set_back = has_future_tasks(transaction, to_micros(now));
    for (const LostTask& lost : find_lost(transaction, to_micros(now), policy.max_attempts)) {
      if (lost.tries >= policy.max_attempts) {
        settle_jobs(transaction, lost.task, "", JobState::kFailed, policy.error, now);
        transaction.change("DELETE FROM task WHERE id = ?1", lost.task);
        ++reaped.failed;
      } else {
        transaction.change(
            "UPDATE task SET state = 0, due = ?2, lease_end = NULL, progress = x'' WHERE id = ?1",
            lost.task,
            to_micros(now) +
                to_micros(delay_after(policy, static_cast<std::uint32_t>(lost.tries))));
        ++reaped.requeued;
      }
    }
    return reaped;
  });
}

StoreResult<Collected> SqliteJobs::collect(const KeepPolicy& policy) {
  const WallTime now = core_->now();
  const std::int64_t aged = to_micros(now - policy.age);
  Collected all;
  const auto ended = collect_in_steps(all, [&] {
    return core_->with_reserve([&] {
      return core_->write(Durability::kLater, [&](Transaction& transaction) {
        Collected step;
        step.jobs = delete_jobs(transaction, aged) +
                    delete_surplus_jobs(transaction, to_sql(policy.jobs_of_owner));
        if (policy.share_of_owner < 1)
          step.meshes = delete_surplus_meshes(transaction, bytes_of_owner(policy));
        step.meshes += delete_meshes(transaction, aged, to_sql(policy.bytes));
        return step;
      });
    });
  });
  if (!ended) return tl::unexpected(ended.error());
  const auto loose = collect_in_steps(all, [&] {
    return core_->with_reserve([&] {
      return core_->write_quietly(Durability::kLater, [&](Transaction& transaction) {
        return delete_loose_chunks(transaction, to_micros(now - policy.loose_age));
      });
    });
  });
  if (!loose) return tl::unexpected(loose.error());
  const auto forgotten = core_->with_reserve([&] {
    return core_->write_quietly(Durability::kLater, [&](Transaction& transaction) {
      forget_what_is_over(transaction, to_micros(now - kSettledAge));
      return true;
    });
  });
  if (!forgotten) return tl::unexpected(forgotten.error());
  if (const auto given = core_->give_space_back(); !given) return tl::unexpected(given.error());
  return all;
}

StoreResult<StoreStats> SqliteJobs::stats() {
  return core_->read([&](Transaction& transaction) {
    StoreStats stats;
    {
      Rows rows = transaction.run(
          "SELECT count(*), CAST(total(weight) AS INTEGER), min(created) FROM task WHERE state = "
          "0");
      if (rows.next()) {
        stats.queued = to_unsigned(rows.integer(0));
        stats.queued_estimate = to_unsigned(rows.integer(1));
        if (stats.queued != 0) {
          const std::int64_t waited =
              to_micros(core_->now()) - to_micros(from_micros(rows.integer(2)));
          stats.oldest_queued_seconds =
              1e-6 * static_cast<double>(std::max<std::int64_t>(waited, 0));
        }
      }
    }
    Rows rows = transaction.run(
        "SELECT (SELECT count(*) FROM task WHERE state = 1), (SELECT count(*) FROM mesh), "
        "(SELECT coalesce(sum(size), 0) FROM chunk)");
    if (rows.next()) {
      stats.running = to_unsigned(rows.integer(0));
      stats.meshes = to_unsigned(rows.integer(1));
      stats.chunk_bytes = to_unsigned(rows.integer(2));
    }
    return stats;
  });
}

}  // namespace weft::server
