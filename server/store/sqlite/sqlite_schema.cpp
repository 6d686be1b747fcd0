// SPDX-License-Identifier: Apache-2.0
#include "server/store/sqlite/sqlite_schema.h"

#include <array>

namespace weft::server {
namespace {

// Times are microseconds since 1970, states the numbers of JobState.
//
// Large blobs live in rows of their own: SQLite writes a row anew as a whole when any column of it
// changes.
constexpr const char* kVersion1 = R"sql(
CREATE TABLE task (
  id        INTEGER PRIMARY KEY AUTOINCREMENT,  -- never given twice: it is part of a claim
  key       BLOB    NOT NULL,
  shared    INTEGER NOT NULL,
  owner     TEXT    NOT NULL,
  job       TEXT    NOT NULL,             -- that made it
  weight    INTEGER NOT NULL,
  state     INTEGER NOT NULL DEFAULT 0,
  created   INTEGER NOT NULL,
  due       INTEGER NOT NULL,
  attempt   INTEGER NOT NULL DEFAULT 0,   -- the fence: only ever grows
  tries     INTEGER NOT NULL DEFAULT 0,   -- the attempts that count
  started   INTEGER,
  lease_end INTEGER,
  worker    TEXT    NOT NULL DEFAULT '',
  progress  BLOB    NOT NULL DEFAULT x''
);
CREATE UNIQUE INDEX task_key ON task (key) WHERE shared;
CREATE INDEX task_turn ON task (state, owner, id, due, weight);

CREATE TABLE task_request (
  task    INTEGER PRIMARY KEY REFERENCES task ON DELETE CASCADE,
  request BLOB    NOT NULL
);

-- When an owner last got a claim: the higher, the later.
CREATE TABLE served (
  owner TEXT    PRIMARY KEY,
  turn  INTEGER NOT NULL
) WITHOUT ROWID;

-- How tasks ended, for those who did not hear the answer.
CREATE TABLE settled (
  task    INTEGER PRIMARY KEY,
  attempt INTEGER NOT NULL,
  state   INTEGER NOT NULL,
  at      INTEGER NOT NULL
);

CREATE TABLE job (
  id         TEXT    PRIMARY KEY,
  owner      TEXT    NOT NULL,
  request_id TEXT,
  key        BLOB    NOT NULL,
  task       INTEGER REFERENCES task,     -- until the job has ended
  state      INTEGER,                     -- from then on; before, the state is the task's
  created    INTEGER NOT NULL,
  started    INTEGER,
  ended      INTEGER,
  attempts   INTEGER NOT NULL DEFAULT 0,
  from_store INTEGER NOT NULL,
  worker     TEXT    NOT NULL DEFAULT '',
  error      BLOB    NOT NULL DEFAULT x'',
  CHECK ((task IS NULL) = (state IS NOT NULL)),
  CHECK ((task IS NULL) = (ended IS NOT NULL))
) WITHOUT ROWID;
CREATE UNIQUE INDEX job_request ON job (owner, request_id) WHERE request_id IS NOT NULL;
CREATE INDEX job_owner ON job (owner, id);
CREATE INDEX job_task ON job (task) WHERE task IS NOT NULL;
CREATE INDEX job_ended ON job (ended) WHERE ended IS NOT NULL;

-- A job as its client sees it.
CREATE VIEW job_now AS
SELECT job.id, job.owner, job.request_id, job.key,
       coalesce(job.state, task.state) AS state,
       job.created,
       CASE WHEN task.id IS NULL THEN job.started ELSE max(job.created, task.started) END AS started,
       job.ended,
       coalesce(task.tries, job.attempts) AS attempts,
       job.from_store,
       coalesce(task.worker, job.worker) AS worker,
       coalesce(task.progress, x'') AS progress,
       job.error
FROM job LEFT JOIN task ON task.id = job.task;

CREATE TABLE mesh (
  id      INTEGER PRIMARY KEY,
  key     BLOB    NOT NULL UNIQUE,
  asked   INTEGER NOT NULL,               -- when somebody last asked for it
  summary BLOB    NOT NULL
);
CREATE INDEX mesh_asked ON mesh (asked);

CREATE TABLE chunk (
  id      INTEGER PRIMARY KEY,
  sha256  BLOB    NOT NULL UNIQUE,
  size    INTEGER NOT NULL,
  touched INTEGER NOT NULL                -- when it was last put
);
CREATE TABLE chunk_bytes (
  chunk INTEGER PRIMARY KEY REFERENCES chunk ON DELETE CASCADE,
  bytes BLOB    NOT NULL
);

CREATE TABLE mesh_chunk (
  mesh  INTEGER NOT NULL REFERENCES mesh ON DELETE CASCADE,
  place INTEGER NOT NULL,
  chunk INTEGER NOT NULL REFERENCES chunk,
  PRIMARY KEY (mesh, place)
) WITHOUT ROWID;
CREATE INDEX mesh_chunk_of ON mesh_chunk (chunk);
)sql";

// What lists show of a mesh is stored apart from its summary, which may take some MiB.
constexpr const char* kVersion2 = R"sql(
ALTER TABLE task ADD COLUMN trace TEXT NOT NULL DEFAULT '';

ALTER TABLE mesh RENAME COLUMN summary TO brief;
CREATE TABLE mesh_summary (
  mesh  INTEGER PRIMARY KEY REFERENCES mesh ON DELETE CASCADE,
  bytes BLOB    NOT NULL
);
INSERT INTO mesh_summary (mesh, bytes) SELECT id, brief FROM mesh;

DROP VIEW job_now;
CREATE VIEW job_now AS
SELECT job.id, job.owner, job.request_id, job.key,
       coalesce(job.state, task.state) AS state,
       job.created,
       CASE WHEN task.id IS NULL THEN job.started ELSE max(job.created, task.started) END AS started,
       job.ended,
       coalesce(task.tries, job.attempts) AS attempts,
       job.from_store,
       coalesce(task.worker, job.worker) AS worker,
       coalesce(task.progress, x'') AS progress,
       job.error,
       job.task,
       coalesce(CASE WHEN job.state = 2 THEN (SELECT brief FROM mesh WHERE mesh.key = job.key) END,
                x'') AS brief
FROM job LEFT JOIN task ON task.id = job.task;
)sql";

// What the work may use. Tasks from before version 3 are shared only by jobs that ask for no
// budget.
constexpr const char* kVersion3 = R"sql(
ALTER TABLE task ADD COLUMN max_bytes  INTEGER NOT NULL DEFAULT 0;
ALTER TABLE task ADD COLUMN max_micros INTEGER NOT NULL DEFAULT 0;
)sql";

// Adds the owners of meshes, and an index of the open jobs of an owner. Meshes from before version
// 4 have no owner.
constexpr const char* kVersion4 = R"sql(
ALTER TABLE mesh ADD COLUMN owner TEXT NOT NULL DEFAULT '';  -- of the job it was made for
CREATE INDEX job_open ON job (owner) WHERE ended IS NULL;
)sql";

// Adds callbacks. `callback_due` is when a callback may be claimed; it is NULL unless the callback
// is pending or claimed, and its job counts only once it has ended.
constexpr const char* kVersion5 = R"sql(
ALTER TABLE job ADD COLUMN callback_url      TEXT    NOT NULL DEFAULT '';
ALTER TABLE job ADD COLUMN callback_place    TEXT    NOT NULL DEFAULT '';
ALTER TABLE job ADD COLUMN callback_state    INTEGER NOT NULL DEFAULT 0;
ALTER TABLE job ADD COLUMN callback_attempts INTEGER NOT NULL DEFAULT 0;
ALTER TABLE job ADD COLUMN callback_error    TEXT    NOT NULL DEFAULT '';
ALTER TABLE job ADD COLUMN callback_due      INTEGER;
CREATE INDEX job_callback ON job (callback_due) WHERE callback_due IS NOT NULL AND ended IS NOT NULL;
CREATE INDEX job_callback_owner ON job (owner) WHERE callback_due IS NOT NULL;

DROP VIEW job_now;
CREATE VIEW job_now AS
SELECT job.id, job.owner, job.request_id, job.key,
       coalesce(job.state, task.state) AS state,
       job.created,
       CASE WHEN task.id IS NULL THEN job.started ELSE max(job.created, task.started) END AS started,
       job.ended,
       coalesce(task.tries, job.attempts) AS attempts,
       job.from_store,
       coalesce(task.worker, job.worker) AS worker,
       coalesce(task.progress, x'') AS progress,
       job.error,
       job.task,
       coalesce(CASE WHEN job.state = 2 THEN (SELECT brief FROM mesh WHERE mesh.key = job.key) END,
                x'') AS brief,
       job.callback_url, job.callback_state, job.callback_attempts, job.callback_error
FROM job LEFT JOIN task ON task.id = job.task;
)sql";

// The n-th brings version n to version n + 1.
constexpr std::array kMigrations{kVersion1, kVersion2, kVersion3, kVersion4, kVersion5};

}  // namespace

StoreResult<void> migrate(sqlite::Connection& connection, const std::string& path) {
  const StoreResult<std::int64_t> found = connection.pragma("PRAGMA user_version");
  if (!found) return tl::unexpected(found.error());
  const auto known = static_cast<std::int64_t>(kMigrations.size());
  if (*found < 0 || *found > known) {
    return tl::unexpected(StoreError{StoreErrorKind::kBroken,
                                     path + " is of version " + std::to_string(*found) +
                                         "; this weftd knows none after " + std::to_string(known)});
  }
  for (std::int64_t version = *found; version < known; ++version) {
    const std::string step = std::string("BEGIN IMMEDIATE;") +
                             kMigrations[static_cast<std::size_t>(version)] +
                             "PRAGMA user_version = " + std::to_string(version + 1) + ";COMMIT";
    if (const auto done = connection.execute(step.c_str()); !done) {
      return tl::unexpected(done.error());  // whoever closes the connection undoes the rest
    }
  }
  return {};
}

}  // namespace weft::server
