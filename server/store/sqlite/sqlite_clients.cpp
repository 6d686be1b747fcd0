// SPDX-License-Identifier: Apache-2.0
// The SQLite store for clients: jobs are accepted, looked at, cancelled and removed, meshes read.
#include "server/store/sql_values.h"
#include "server/store/sqlite/sqlite_jobs.h"

namespace weft::server {

using sqlite::Blob;
using sqlite::Rows;
using sqlite::Transaction;

namespace {

constexpr std::string_view kJobById = "SELECT * FROM job_now WHERE owner = ?1 AND id = ?2";
constexpr std::string_view kJobByRequestId =
    "SELECT * FROM job_now WHERE owner = ?1 AND request_id = ?2";
constexpr std::string_view kJobsOfOwner =
    "SELECT * FROM job_now WHERE owner = ?1 AND id < ?2 AND (1 << state) & ?3 ORDER BY id DESC "
    "LIMIT ?4";

// The tasks that wait.
std::uint64_t count_queued(Transaction& transaction) {
  Rows rows = transaction.run("SELECT count(*) FROM task WHERE state = 0");
  return rows.next() ? to_unsigned(rows.integer(0)) : 0;
}

// The owner's jobs that have not ended.
std::uint64_t count_open(Transaction& transaction, const std::string& owner) {
  Rows rows = transaction.run("SELECT count(*) FROM job WHERE owner = ?1 AND ended IS NULL", owner);
  return rows.next() ? to_unsigned(rows.integer(0)) : 0;
}

// The owner's callbacks that are neither delivered nor failed.
std::uint64_t count_callbacks(Transaction& transaction, const std::string& owner) {
  Rows rows = transaction.run(
      "SELECT count(*) FROM job WHERE owner = ?1 AND callback_due IS NOT NULL", owner);
  return rows.next() ? to_unsigned(rows.integer(0)) : 0;
}

}  // namespace

std::optional<JobRecord> find_job(Transaction& transaction, const std::string& owner,
                                  const std::string& id) {
  Rows rows = transaction.run(kJobById, owner, id);
  if (!rows.next()) return std::nullopt;
  return read_job(rows);
}

void settle_jobs(Transaction& transaction, std::int64_t task, const std::string& job,
                 JobState state, const std::string& error, WallTime now) {
  transaction.change(
      "UPDATE job SET task = NULL, state = ?3, ended = ?4, error = ?5, attempts = task.tries, "
      "worker = task.worker, started = max(job.created, task.started) "
      "FROM task WHERE task.id = ?1 AND job.task = ?1 AND (?2 = '' OR job.id = ?2)",
      task, job, static_cast<int>(state), to_micros(now), Blob{error});
}

StoreResult<Submitted> SqliteJobs::submit(const Submission& submission) {
  return core_->write(Durability::kWait, [&](Transaction& transaction) {
    JobRecord fresh;
    fresh.created = core_->now();
    fresh.id = ids_.next(fresh.created);
    return submit_in(transaction, submission, fresh);
  });
}

Submitted SqliteJobs::submit_in(Transaction& transaction, const Submission& submission,
                                const JobRecord& fresh) {
  const Blob key{submission.key};
  const std::int64_t now = to_micros(fresh.created);
  const std::int64_t max_bytes = to_sql(submission.budget.bytes);
  const std::int64_t max_micros = to_micros(submission.budget.time);
  std::optional<std::string_view> request_id;
  if (!submission.request_id.empty()) {
    request_id = submission.request_id;
    Rows rows = transaction.run(kJobByRequestId, submission.owner, submission.request_id);
    if (rows.next()) {
      JobRecord earlier = read_job(rows);
      const bool same = earlier.key == submission.key;
      return {same ? SubmitOutcome::kFound : SubmitOutcome::kConflict, std::move(earlier)};
    }
  }

  std::optional<std::int64_t> task;
  std::optional<std::int64_t> state;
  std::optional<std::int64_t> ended;
  if (!submission.no_cache) {
    if (transaction.change("UPDATE mesh SET asked = ?2 WHERE key = ?1", key, now) == 1) {
      state = static_cast<int>(JobState::kSucceeded);
      ended = now;
    } else {
      Rows rows = transaction.run(
          "SELECT id FROM task WHERE key = ?1 AND shared AND max_bytes >= ?2 AND max_micros >= ?3",
          key, max_bytes, max_micros);
      if (rows.next()) task = rows.integer(0);
    }
  }
  if (!ended && count_open(transaction, submission.owner) >= submission.max_open_of_owner)
    return {SubmitOutcome::kOwnerFull, {}};
  const bool calls_back = !submission.callback.url.empty();
  if (calls_back &&
      count_callbacks(transaction, submission.owner) >= submission.max_callbacks_of_owner)
    return {SubmitOutcome::kCallbacksFull, {}};
  if (!task && !ended) {
    if (count_queued(transaction) >= submission.max_queued) return {SubmitOutcome::kQueueFull, {}};
    // One with a smaller budget is shared no more.
    if (!submission.no_cache)
      transaction.change("UPDATE task SET shared = 0 WHERE key = ?1 AND shared", key);
    Rows rows = transaction.run(
        "INSERT INTO task (key, shared, owner, job, weight, created, due, trace, max_bytes, "
        "max_micros) VALUES (?1, ?2, ?3, ?4, ?5, ?6, 0, ?7, ?8, ?9) RETURNING id",
        key, !submission.no_cache, submission.owner, fresh.id, to_sql(submission.estimate), now,
        submission.trace, max_bytes, max_micros);
    if (rows.next()) task = rows.integer(0);
    transaction.change("INSERT INTO task_request (task, request) VALUES (?1, ?2)", task,
                       Blob{submission.request});
  }
  transaction.change(
      "INSERT INTO job (id, owner, request_id, key, task, state, created, ended, from_store, "
      "callback_url, callback_place, callback_state, callback_due) "
      "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13)",
      fresh.id, submission.owner, request_id, key, task, state, now, ended, ended.has_value(),
      submission.callback.url, submission.callback.place,
      static_cast<int>(calls_back ? CallbackState::kPending : CallbackState::kNone),
      calls_back ? std::optional(now) : std::nullopt);
  return {SubmitOutcome::kAccepted,
          find_job(transaction, submission.owner, fresh.id).value_or(JobRecord{})};
}

StoreResult<std::optional<JobRecord>> SqliteJobs::get(const std::string& owner,
                                                      const std::string& id) {
  return core_->read([&](Transaction& transaction) { return find_job(transaction, owner, id); });
}

StoreResult<std::vector<JobRecord>> SqliteJobs::list(const ListQuery& query) {
  if (!query.before.empty() && !is_job_id(query.before)) return std::vector<JobRecord>();
  // '~' sorts after every id.
  const std::string before = query.before.empty() ? "~" : query.before;
  return core_->read([&](Transaction& transaction) {
    std::vector<JobRecord> jobs;
    Rows rows = transaction.run(kJobsOfOwner, query.owner, before, bits_of(query.states),
                                to_sql(query.limit));
    while (rows.next()) jobs.push_back(read_job(rows));
    return jobs;
  });
}

StoreResult<std::optional<JobRecord>> SqliteJobs::cancel(const std::string& owner,
                                                         const std::string& id) {
  return core_->with_reserve([&] {
    return core_->write(Durability::kWait, [&](Transaction& transaction) {
      std::optional<std::int64_t> task;
      {
        Rows rows = transaction.run(
            "SELECT task FROM job WHERE owner = ?1 AND id = ?2 AND task IS NOT NULL", owner, id);
        if (rows.next()) task = rows.integer(0);
      }
      if (task) {
        settle_jobs(transaction, *task, id, JobState::kCancelled, "", core_->now());
        transaction.change(
            "DELETE FROM task WHERE id = ?1 AND NOT EXISTS (SELECT * FROM job WHERE task = ?1)",
            *task);
      }
      return find_job(transaction, owner, id);
    });
  });
}

StoreResult<std::optional<JobRecord>> SqliteJobs::remove(const std::string& owner,
                                                         const std::string& id) {
  return core_->with_reserve([&] {
    return core_->write(Durability::kWait, [&](Transaction& transaction) {
      std::optional<JobRecord> job = find_job(transaction, owner, id);
      if (job && is_final(job->state)) transaction.change("DELETE FROM job WHERE id = ?1", id);
      return job;
    });
  });
}

StoreResult<std::optional<StoredMesh>> SqliteJobs::mesh(const std::string& key) {
  auto found = core_->read([&](Transaction& transaction) {
    std::optional<StoredMesh> mesh;
    Rows rows = transaction.run(
        "SELECT id, bytes, brief FROM mesh JOIN mesh_summary ON mesh = id WHERE key = ?1",
        Blob{key});
    if (!rows.next()) return mesh;
    mesh.emplace().summary = rows.bytes(1);
    mesh->brief = rows.bytes(2);
    Rows chunks = transaction.run(
        "SELECT sha256, size FROM mesh_chunk JOIN chunk ON chunk.id = chunk WHERE mesh = ?1 "
        "ORDER BY place",
        rows.integer(0));
    while (chunks.next()) {
      mesh->chunks.push_back({chunks.bytes(0), to_unsigned(chunks.integer(1))});
    }
    return mesh;
  });
  if (found && *found) {
    // Where this fails, as on a disk that is full, the mesh is there all the same.
    core_->write_quietly(Durability::kLater, [&](Transaction& transaction) {
      return transaction.change("UPDATE mesh SET asked = ?2 WHERE key = ?1", Blob{key},
                                to_micros(core_->now()));
    });
  }
  return found;
}

StoreResult<std::optional<std::string>> SqliteJobs::chunk(const std::string& sha256) {
  return core_->read([&](Transaction& transaction) {
    std::optional<std::string> bytes;
    Rows rows = transaction.run("SELECT id FROM chunk WHERE sha256 = ?1", Blob{sha256});
    if (rows.next()) bytes = transaction.blob("chunk_bytes", "bytes", rows.integer(0));
    return bytes;
  });
}

StoreResult<std::uint64_t> SqliteJobs::drop_damaged(const std::string& sha256,
                                                    std::string_view bytes) {
  return core_->write(Durability::kLater, [&](Transaction& transaction) {
    std::uint64_t meshes = 0;
    std::optional<std::int64_t> chunk;
    {
      Rows rows = transaction.run("SELECT id FROM chunk WHERE sha256 = ?1", Blob{sha256});
      if (rows.next()) chunk = rows.integer(0);
    }
    if (!chunk || transaction.blob("chunk_bytes", "bytes", *chunk) != bytes) return meshes;
    {
      Rows rows =
          transaction.run("SELECT count(DISTINCT mesh) FROM mesh_chunk WHERE chunk = ?1", *chunk);
      if (rows.next()) meshes = to_unsigned(rows.integer(0));
    }
    transaction.change(
        "DELETE FROM mesh WHERE id IN (SELECT mesh FROM mesh_chunk WHERE chunk = ?1)", *chunk);
    transaction.change("DELETE FROM chunk WHERE id = ?1", *chunk);
    return meshes;
  });
}

}  // namespace weft::server
