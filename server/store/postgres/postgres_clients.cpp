// SPDX-License-Identifier: Apache-2.0
// The PostgreSQL store for clients: jobs are accepted, looked at, cancelled and removed, meshes
// read.
#include "server/store/postgres/postgres_jobs.h"
#include "server/store/sql_values.h"

namespace weft::server {

using postgres::Begin;
using postgres::Blob;
using postgres::Rows;
using postgres::Transaction;

namespace {

constexpr std::int64_t kQueueLock = 0x77656674'0002;

constexpr const char* kJobById = "SELECT * FROM weft_job_now WHERE owner = $1 AND id = $2";
constexpr const char* kJobByRequestId =
    "SELECT * FROM weft_job_now WHERE owner = $1 AND request_id = $2";
constexpr const char* kJobsOfOwner =
    "SELECT * FROM weft_job_now "
    "WHERE owner = $1 AND id < $2 AND (1 << state::int) & $3 <> 0 ORDER BY id DESC LIMIT $4";

// A task that a job may join. It does not end before the transaction does.
std::optional<std::int64_t> find_shared_task(Transaction& transaction,
                                             const Submission& submission) {
  Rows rows = transaction.run(
      "SELECT id FROM weft_task WHERE key = $1 AND shared AND max_bytes >= $2 AND max_micros >= $3 "
      "FOR KEY SHARE",
      Blob{submission.key}, to_sql(submission.budget.bytes), to_micros(submission.budget.time));
  if (!rows.next()) return std::nullopt;
  return rows.integer(0);
}

bool ask_for_mesh(Transaction& transaction, const std::string& key) {
  return transaction.change("UPDATE weft_mesh SET asked = clock_timestamp() WHERE key = $1",
                            Blob{key}) == 1;
}

void end_task_without_jobs(Transaction& transaction, std::int64_t task) {
  transaction.change(
      "DELETE FROM weft_task WHERE id = $1 AND NOT EXISTS "
      "(SELECT FROM weft_job WHERE task = $1)",
      task);
}

// `packed` holds digests in order, each followed by its size, the highest byte first.
std::vector<StoredChunk> read_chunks(std::string_view packed) {
  constexpr std::size_t kDigest = 32;
  constexpr std::size_t kEach = kDigest + 8;
  std::vector<StoredChunk> chunks(packed.size() / kEach);
  for (StoredChunk& chunk : chunks) {
    chunk.sha256 = packed.substr(0, kDigest);
    for (const char byte : packed.substr(kDigest, 8)) {
      chunk.bytes = chunk.bytes << 8 | static_cast<unsigned char>(byte);
    }
    packed.remove_prefix(kEach);
  }
  return chunks;
}

// The owner's jobs that have not ended.
std::uint64_t count_open(Transaction& transaction, const std::string& owner) {
  Rows rows =
      transaction.run("SELECT count(*) FROM weft_job WHERE owner = $1 AND ended IS NULL", owner);
  return rows.next() ? to_unsigned(rows.integer(0)) : 0;
}

// The owner's callbacks that are neither delivered nor failed.
std::uint64_t count_callbacks(Transaction& transaction, const std::string& owner) {
  Rows rows = transaction.run(
      "SELECT count(*) FROM weft_job WHERE owner = $1 AND callback_due IS NOT NULL", owner);
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
                 JobState state, const std::string& error) {
  transaction.change(
      "UPDATE weft_job AS job SET task = NULL, state = $3, ended = clock_timestamp(), error = $4, "
      "attempts = task.tries, worker = task.worker, started = CASE WHEN task.started IS NOT NULL "
      "THEN greatest(job.created, task.started) END "
      "FROM weft_task AS task WHERE task.id = $1 AND job.task = $1 AND ($2 = '' OR job.id = $2)",
      task, job, static_cast<int>(state), Blob{error});
}

StoreResult<Submitted> PostgresJobs::submit(const Submission& submission) {
  // Given once, so that a second attempt finds what the first one may have stored.
  const std::string id = ids_.next(std::chrono::system_clock::now());
  bool again = false;
  return core_->run(Begin::kDurable, Repeat::kWhenUnclear, [&](Transaction& transaction) {
    if (again) {
      if (auto earlier = find_job(transaction, submission.owner, id)) {
        return Submitted{SubmitOutcome::kAccepted, std::move(*earlier)};
      }
    }
    again = true;
    return submit_in(transaction, submission, id);
  });
}

Submitted PostgresJobs::submit_in(Transaction& transaction, const Submission& submission,
                                  const std::string& id) {
  if (!submission.request_id.empty()) {
    // If several come at once with the same request id, all but the first wait for it.
    transaction.run("SELECT pg_advisory_xact_lock(hashtextextended($1, hashtext($2)))",
                    submission.owner, submission.request_id);
    Rows rows = transaction.run(kJobByRequestId, submission.owner, submission.request_id);
    if (rows.next()) {
      JobRecord earlier = read_job(rows);
      const bool same = earlier.key == submission.key;
      return {same ? SubmitOutcome::kFound : SubmitOutcome::kConflict, std::move(earlier)};
    }
  }

  std::optional<std::int64_t> task;
  bool kept = false;
  // The task first: it may become a mesh between the two statements.
  const auto find = [&] {
    if (submission.no_cache) return false;
    task = find_shared_task(transaction, submission);
    kept = !task && ask_for_mesh(transaction, submission.key);
    return task || kept;
  };
  const bool found = find();
  // Not locked: submissions that come at once may exceed these limits.
  if (!kept && count_open(transaction, submission.owner) >= submission.max_open_of_owner)
    return {SubmitOutcome::kOwnerFull, {}};
  if (!submission.callback.url.empty() &&
      count_callbacks(transaction, submission.owner) >= submission.max_callbacks_of_owner)
    return {SubmitOutcome::kCallbacksFull, {}};
  if (!found) {
    // One submission at a time, so that the tasks are counted correctly, and none is added twice.
    transaction.run("SELECT pg_advisory_xact_lock($1)", kQueueLock);
    if (!find()) {
      Rows queued = transaction.run("SELECT count(*) FROM weft_task WHERE state = 0");
      if (queued.next() && to_unsigned(queued.integer(0)) >= submission.max_queued)
        return {SubmitOutcome::kQueueFull, {}};
      // An earlier task with a smaller budget is no longer shared.
      if (!submission.no_cache)
        transaction.change("UPDATE weft_task SET shared = false WHERE key = $1 AND shared",
                           Blob{submission.key});
      Rows made = transaction.run(
          "INSERT INTO weft_task (key, shared, owner, job, weight, request, trace, max_bytes, "
          "max_micros, due) VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, '-infinity') RETURNING id",
          Blob{submission.key}, !submission.no_cache, submission.owner, id,
          to_sql(submission.estimate), Blob{submission.request}, submission.trace,
          to_sql(submission.budget.bytes), to_micros(submission.budget.time));
      if (made.next()) task = made.integer(0);
    }
  }
  insert_job(transaction, submission, id, task);
  core_->announce(transaction);
  return {SubmitOutcome::kAccepted,
          find_job(transaction, submission.owner, id).value_or(JobRecord{})};
}

// A job without a task has succeeded.
void PostgresJobs::insert_job(Transaction& transaction, const Submission& submission,
                              const std::string& id, std::optional<std::int64_t> task) {
  std::optional<std::string_view> request_id;
  if (!submission.request_id.empty()) request_id = submission.request_id;
  std::optional<std::int64_t> state;
  if (!task) state = static_cast<int>(JobState::kSucceeded);
  transaction.change(
      "INSERT INTO weft_job (id, owner, request_id, key, task, state, created, ended, from_store, "
      "callback_url, callback_place, callback_state, callback_due) "
      "SELECT $1, $2, $3, $4, $5, $6, now, CASE WHEN $6 IS NOT NULL THEN now END, $6 IS NOT NULL, "
      "$7, $8, $9, CASE WHEN $7 <> '' THEN now END FROM clock_timestamp() AS now",
      id, submission.owner, request_id, Blob{submission.key}, task, state, submission.callback.url,
      submission.callback.place,
      static_cast<int>(submission.callback.url.empty() ? CallbackState::kNone
                                                       : CallbackState::kPending));
}

StoreResult<std::optional<JobRecord>> PostgresJobs::get(const std::string& owner,
                                                        const std::string& id) {
  if (!is_job_id(id)) return std::nullopt;
  return core_->run(Begin::kOneStatement, Repeat::kWhenUnclear,
                    [&](Transaction& transaction) { return find_job(transaction, owner, id); });
}

StoreResult<std::vector<JobRecord>> PostgresJobs::list(const ListQuery& query) {
  if (!query.before.empty() && !is_job_id(query.before)) return std::vector<JobRecord>();
  // '~' sorts after every id.
  const std::string before = query.before.empty() ? "~" : query.before;
  return core_->run(Begin::kOneStatement, Repeat::kWhenUnclear, [&](Transaction& transaction) {
    std::vector<JobRecord> jobs;
    Rows rows = transaction.run(kJobsOfOwner, query.owner, before, bits_of(query.states),
                                to_sql(query.limit));
    while (rows.next()) jobs.push_back(read_job(rows));
    return jobs;
  });
}

StoreResult<std::optional<JobRecord>> PostgresJobs::cancel(const std::string& owner,
                                                           const std::string& id) {
  if (!is_job_id(id)) return std::nullopt;
  return core_->run(Begin::kDurable, Repeat::kWhenUnclear, [&](Transaction& transaction) {
    std::optional<std::int64_t> task;
    {
      Rows rows = transaction.run(
          "SELECT id FROM weft_task WHERE id = "
          "(SELECT task FROM weft_job WHERE owner = $1 AND id = $2) FOR UPDATE",
          owner, id);
      if (rows.next()) task = rows.integer(0);
    }
    if (task) {
      settle_jobs(transaction, *task, id, JobState::kCancelled, "");
      end_task_without_jobs(transaction, *task);
      core_->announce(transaction);
    }
    return find_job(transaction, owner, id);
  });
}

StoreResult<std::optional<JobRecord>> PostgresJobs::remove(const std::string& owner,
                                                           const std::string& id) {
  if (!is_job_id(id)) return std::nullopt;
  return core_->run(Begin::kDurable, Repeat::kNever, [&](Transaction& transaction) {
    std::optional<JobRecord> job = find_job(transaction, owner, id);
    if (job && is_final(job->state)) {
      transaction.change("DELETE FROM weft_job WHERE id = $1", id);
      core_->announce(transaction);
    }
    return job;
  });
}

StoreResult<std::optional<StoredMesh>> PostgresJobs::mesh(const std::string& key) {
  auto found =
      core_->run(Begin::kOneStatement, Repeat::kWhenUnclear, [&](Transaction& transaction) {
        std::optional<StoredMesh> mesh;
        // The chunks as one value: their digests in order, each followed by its size.
        Rows rows = transaction.run(
            "SELECT summary, brief, (SELECT string_agg(sha256 || int8send(size), ''::bytea ORDER "
            "BY place)"
            " FROM weft_mesh_chunk JOIN weft_chunk ON sha256 = chunk WHERE mesh = weft_mesh.id) "
            "FROM weft_mesh WHERE key = $1",
            Blob{key});
        if (!rows.next()) return mesh;
        mesh.emplace().summary = rows.bytes(0);
        mesh->brief = rows.bytes(1);
        mesh->chunks = read_chunks(rows.bytes(2));
        return mesh;
      });
  if (found && *found) {
    // If this fails, for example because the disk is full, the mesh is there all the same.
    (void)core_->run(Begin::kLater, Repeat::kNever,
                     [&](Transaction& transaction) { return ask_for_mesh(transaction, key); });
  }
  return found;
}

StoreResult<std::optional<std::string>> PostgresJobs::chunk(const std::string& sha256) {
  return core_->run(Begin::kOneStatement, Repeat::kWhenUnclear, [&](Transaction& transaction) {
    std::optional<std::string> bytes;
    Rows rows = transaction.run("SELECT bytes FROM weft_chunk WHERE sha256 = $1", Blob{sha256});
    if (rows.next()) bytes = rows.bytes(0);
    return bytes;
  });
}

StoreResult<std::uint64_t> PostgresJobs::drop_damaged(const std::string& sha256,
                                                      std::string_view bytes) {
  return core_->run(Begin::kLater, Repeat::kWhenUnclear, [&](Transaction& transaction) {
    std::uint64_t meshes = 0;
    const bool damaged = transaction
                             .run(
                                 "SELECT 1 FROM weft_chunk WHERE sha256 = $1 AND bytes = $2 "
                                 "FOR UPDATE",
                                 Blob{sha256}, Blob{bytes})
                             .next();
    if (!damaged) return meshes;
    meshes = to_unsigned(transaction.change(
        "DELETE FROM weft_mesh WHERE id IN (SELECT mesh FROM weft_mesh_chunk WHERE chunk = $1)",
        Blob{sha256}));
    transaction.change("DELETE FROM weft_chunk WHERE sha256 = $1", Blob{sha256});
    core_->announce(transaction);
    return meshes;
  });
}

}  // namespace weft::server
