// SPDX-License-Identifier: Apache-2.0
#include "server/store/postgres/postgres_schema.h"

#include <array>
#include <string>

namespace weft::server {
namespace {

// The columns mean what those with the same names in sqlite_schema.cpp mean.
//
// Requests and chunks are coordinates and connectivity, which do not compress well. Values that are
// stored out of line are not written again when other columns change.
constexpr const char* kVersion1 = R"sql(
CREATE TABLE weft_task (
  id        bigint      GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  key       bytea       NOT NULL,
  shared    boolean     NOT NULL,
  owner     text        NOT NULL,
  job       text        NOT NULL,
  weight    bigint      NOT NULL,
  state     bigint      NOT NULL DEFAULT 0,
  created   timestamptz NOT NULL DEFAULT clock_timestamp(),
  due       timestamptz NOT NULL DEFAULT clock_timestamp(),
  attempt   bigint      NOT NULL DEFAULT 0,
  tries     bigint      NOT NULL DEFAULT 0,
  started   timestamptz,
  lease_end timestamptz,
  worker    text        NOT NULL DEFAULT '',
  progress  bytea       NOT NULL DEFAULT '',
  request   bytea       NOT NULL
);
ALTER TABLE weft_task ALTER COLUMN request SET STORAGE EXTERNAL;
CREATE UNIQUE INDEX weft_task_key ON weft_task (key) WHERE shared;
CREATE INDEX weft_task_queued ON weft_task (owner, id) INCLUDE (due, weight) WHERE state = 0;
CREATE INDEX weft_task_running ON weft_task (owner) WHERE state = 1;

CREATE SEQUENCE weft_turn;
CREATE TABLE weft_served (
  owner text   PRIMARY KEY,
  turn  bigint NOT NULL
);

CREATE TABLE weft_settled (
  task    bigint      PRIMARY KEY,
  attempt bigint      NOT NULL,
  state   bigint      NOT NULL,
  at      timestamptz NOT NULL DEFAULT clock_timestamp()
);

CREATE TABLE weft_job (
  id         text COLLATE "C" PRIMARY KEY,
  owner      text        NOT NULL,
  request_id text,
  key        bytea       NOT NULL,
  task       bigint      REFERENCES weft_task,
  state      bigint,
  created    timestamptz NOT NULL,
  started    timestamptz,
  ended      timestamptz,
  attempts   bigint      NOT NULL DEFAULT 0,
  from_store boolean     NOT NULL,
  worker     text        NOT NULL DEFAULT '',
  error      bytea       NOT NULL DEFAULT '',
  CHECK ((task IS NULL) = (state IS NOT NULL)),
  CHECK ((task IS NULL) = (ended IS NOT NULL))
);
CREATE UNIQUE INDEX weft_job_request ON weft_job (owner, request_id) WHERE request_id IS NOT NULL;
CREATE INDEX weft_job_owner ON weft_job (owner, id);
CREATE INDEX weft_job_task ON weft_job (task) WHERE task IS NOT NULL;
CREATE INDEX weft_job_ended ON weft_job (ended) WHERE ended IS NOT NULL;

-- Microseconds since 1970.
CREATE FUNCTION weft_micros(timestamptz) RETURNS bigint LANGUAGE sql IMMUTABLE
  AS 'SELECT (extract(epoch FROM $1) * 1000000)::bigint';

-- A job as its client sees it.
CREATE VIEW weft_job_now AS
SELECT job.id, job.owner, job.request_id, job.key,
       coalesce(job.state, task.state) AS state,
       weft_micros(job.created) AS created,
       weft_micros(CASE WHEN task.started IS NULL THEN job.started
                        ELSE greatest(job.created, task.started) END) AS started,
       weft_micros(job.ended) AS ended,
       coalesce(task.tries, job.attempts) AS attempts,
       job.from_store,
       coalesce(task.worker, job.worker) AS worker,
       coalesce(task.progress, '') AS progress,
       job.error
FROM weft_job AS job LEFT JOIN weft_task AS task ON task.id = job.task;

CREATE TABLE weft_mesh (
  id      bigint      GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  key     bytea       NOT NULL UNIQUE,
  asked   timestamptz NOT NULL DEFAULT clock_timestamp(),
  summary bytea       NOT NULL
);
CREATE INDEX weft_mesh_asked ON weft_mesh (asked);

CREATE TABLE weft_chunk (
  sha256  bytea       PRIMARY KEY,
  size    bigint      NOT NULL,
  touched timestamptz NOT NULL DEFAULT clock_timestamp(),
  bytes   bytea       NOT NULL
);
ALTER TABLE weft_chunk ALTER COLUMN bytes SET STORAGE EXTERNAL;

CREATE TABLE weft_mesh_chunk (
  mesh  bigint NOT NULL REFERENCES weft_mesh ON DELETE CASCADE,
  place bigint NOT NULL,
  chunk bytea  NOT NULL REFERENCES weft_chunk,
  PRIMARY KEY (mesh, place)
);
CREATE INDEX weft_mesh_chunk_of ON weft_mesh_chunk (chunk);
)sql";

// What lists show of a mesh is stored apart from its summary, which may take some MiB. Servers of
// version 1 that are still running go on working.
constexpr const char* kVersion2 = R"sql(
ALTER TABLE weft_task ADD COLUMN trace text NOT NULL DEFAULT '';

ALTER TABLE weft_mesh ADD COLUMN brief bytea NOT NULL DEFAULT '';
UPDATE weft_mesh SET brief = summary;

CREATE OR REPLACE VIEW weft_job_now AS
SELECT job.id, job.owner, job.request_id, job.key,
       coalesce(job.state, task.state) AS state,
       weft_micros(job.created) AS created,
       weft_micros(CASE WHEN task.started IS NULL THEN job.started
                        ELSE greatest(job.created, task.started) END) AS started,
       weft_micros(job.ended) AS ended,
       coalesce(task.tries, job.attempts) AS attempts,
       job.from_store,
       coalesce(task.worker, job.worker) AS worker,
       coalesce(task.progress, '') AS progress,
       job.error,
       job.task,
       coalesce(CASE WHEN job.state = 2 THEN
                (SELECT brief FROM weft_mesh AS mesh WHERE mesh.key = job.key) END, '') AS brief
FROM weft_job AS job LEFT JOIN weft_task AS task ON task.id = job.task;
)sql";

constexpr const char* kVersion3 = R"sql(
ALTER TABLE weft_task ADD COLUMN max_bytes  bigint NOT NULL DEFAULT 0;
ALTER TABLE weft_task ADD COLUMN max_micros bigint NOT NULL DEFAULT 0;
)sql";

// Servers of version 3 that are still running store meshes without an owner.
constexpr const char* kVersion4 = R"sql(
ALTER TABLE weft_mesh ADD COLUMN owner text NOT NULL DEFAULT '';
CREATE INDEX weft_job_open ON weft_job (owner) WHERE ended IS NULL;
)sql";

// Servers of version 4 that are still running end jobs, whose callbacks are then sent, but may
// collect them before.
constexpr const char* kVersion5 = R"sql(
ALTER TABLE weft_job
  ADD COLUMN callback_url      text        NOT NULL DEFAULT '',
  ADD COLUMN callback_place    text        NOT NULL DEFAULT '',
  ADD COLUMN callback_state    bigint      NOT NULL DEFAULT 0,
  ADD COLUMN callback_attempts bigint      NOT NULL DEFAULT 0,
  ADD COLUMN callback_error    text        NOT NULL DEFAULT '',
  ADD COLUMN callback_due      timestamptz;
CREATE INDEX weft_job_callback ON weft_job (callback_due)
  WHERE callback_due IS NOT NULL AND ended IS NOT NULL;
CREATE INDEX weft_job_callback_owner ON weft_job (owner) WHERE callback_due IS NOT NULL;

CREATE OR REPLACE VIEW weft_job_now AS
SELECT job.id, job.owner, job.request_id, job.key,
       coalesce(job.state, task.state) AS state,
       weft_micros(job.created) AS created,
       weft_micros(CASE WHEN task.started IS NULL THEN job.started
                        ELSE greatest(job.created, task.started) END) AS started,
       weft_micros(job.ended) AS ended,
       coalesce(task.tries, job.attempts) AS attempts,
       job.from_store,
       coalesce(task.worker, job.worker) AS worker,
       coalesce(task.progress, '') AS progress,
       job.error,
       job.task,
       coalesce(CASE WHEN job.state = 2 THEN
                (SELECT brief FROM weft_mesh AS mesh WHERE mesh.key = job.key) END, '') AS brief,
       job.callback_url, job.callback_state, job.callback_attempts, job.callback_error
FROM weft_job AS job LEFT JOIN weft_task AS task ON task.id = job.task;
)sql";

// The n-th brings version n to version n + 1.
constexpr std::array kMigrations{kVersion1, kVersion2, kVersion3, kVersion4, kVersion5};

// A number that other programs are unlikely to lock.
constexpr std::int64_t kMigrationLock = 0x77656674'0001;

}  // namespace

StoreResult<void> migrate(postgres::Connection& connection) {
  postgres::Transaction transaction(connection, postgres::Begin::kDurable);
  transaction.run("SELECT pg_advisory_xact_lock($1)", kMigrationLock);
  transaction.change("CREATE TABLE IF NOT EXISTS weft_schema (version bigint NOT NULL)");
  std::int64_t found = 0;
  {
    postgres::Rows rows = transaction.run("SELECT coalesce(max(version), 0) FROM weft_schema");
    if (rows.next()) found = rows.integer(0);
  }
  const auto known = static_cast<std::int64_t>(kMigrations.size());
  if (found < 0 || found > known) {
    transaction.fail(
        {StoreErrorKind::kBroken, "the database is of version " + std::to_string(found) +
                                      "; this weftd knows none after " + std::to_string(known)});
  }
  for (std::int64_t version = found; version < known && !transaction.failed(); ++version) {
    const auto done = connection.execute_patiently(kMigrations[static_cast<std::size_t>(version)]);
    if (!done) transaction.fail(done.error());
    transaction.change("INSERT INTO weft_schema (version) VALUES ($1)", version + 1);
  }
  return transaction.commit();
}

}  // namespace weft::server
