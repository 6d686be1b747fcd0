// SPDX-License-Identifier: Apache-2.0
// What outlives a server: the jobs, the work that is still to be done for them, and the meshes that
// were made. Two kinds exist, in one file (sqlite_store.h) and for several servers
// (postgres_store.h); one suite of tests holds both to the laws below.
//
// Three things are kept apart:
//   job    what one client asked for, and what became of it; lives until deleted or collected
//   task   a mesh to be made, for one or more jobs; lives while any of them waits for it
//   mesh   a mesh that was made: a summary and chunks, each known by its SHA-256
//
// The store does not look into requests, progress, errors, summaries and chunks: they are bytes.
// `key` names a mesh: 32 bytes, a digest of the request and the engine version, and of the owner if
// clients share nothing. Jobs of the same key share a task, and find the mesh once it is made.
//
// Laws, whatever fails and whenever:
//   1. A job whose submission was answered is there, and reaches exactly one final state.
//   2. A task is held by at most one claim. A claim is a lease: when it was not renewed in time,
//      `reap` takes it away, and the next claim has a higher attempt. Whoever holds an older one
//      changes nothing any more: `renew`, `finish`, `fail` and `release` answer kLost. A claim that
//      has settled its task may settle it the same way again, and is told kHeld: whoever got no
//      answer asks once more.
//   3. A mesh is whole: `finish` settles the mesh, the task and all jobs in one transaction, and
//      only if every chunk is there.
//   4. No transaction is open between two calls.
//
// Errors: see StoreError. Every function may block on the disk or the network: none is called on a
// thread of gRPC. Thread-safety: every function may be called from any thread.
//
//   auto store = SqliteStore::open({.folder = "/var/lib/weft"});
//   if (!store) return complain(store.error());
//   auto job = (*store)->submit({.owner = "ann", .key = key, .request = bytes, .estimate = 1 <<
//   20}); auto claim = (*store)->claim("worker-1", std::chrono::seconds(30), 1 << 30);
//   ... (*store)->put_chunk(sha256, chunk) ... (*store)->finish(claim->ref, mesh) ...
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/store/store_error.h"

namespace weft::server {

enum class JobState { kQueued, kRunning, kSucceeded, kFailed, kCancelled };

constexpr bool is_final(JobState state) {
  return state != JobState::kQueued && state != JobState::kRunning;
}

using WallTime = std::chrono::system_clock::time_point;  // stored to the microsecond

struct JobRecord {
  std::string id;          // given by the store: unique for ever, 26 characters, sorts by time
  std::string owner;       // empty if callers are not told apart
  std::string request_id;  // empty: none
  std::string key;
  JobState state = JobState::kQueued;
  WallTime created;
  std::optional<WallTime> started;  // of the first attempt
  std::optional<WallTime> ended;
  std::uint32_t attempts = 0;
  std::string worker;    // of the last attempt
  std::string progress;  // as last renewed; empty unless running
  std::string error;     // empty unless failed
  bool from_store = false;
  std::optional<std::int64_t> task;  // that it waits for; nothing once it has ended
  std::string brief;                 // of its mesh; empty unless succeeded, and the mesh is kept
};

// What the work on a task may use.
struct WorkBudget {
  std::uint64_t bytes = 0;  // of engine memory
  std::chrono::microseconds time{0};
};

struct Submission {
  std::string owner{};
  std::string request_id{};
  std::string key{};
  std::string request{};       // what a worker needs
  std::uint64_t estimate = 0;  // bytes of memory that the work is expected to take
  // The job joins a task of its key only if that may use as much. Otherwise it makes a task that
  // later jobs join in the other's stead.
  WorkBudget budget{};
  std::string trace{};  // of the call, for the log of whoever does the work
  // Make a mesh even if one is kept, and share no task. What comes of it replaces what is kept.
  bool no_cache = false;
  // Tasks that wait, of all and of this owner; at these numbers no further one is taken. Jobs that
  // join a task or find a mesh are always taken.
  std::uint64_t max_queued = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t max_queued_of_owner = std::numeric_limits<std::uint64_t>::max();
};

enum class SubmitOutcome {
  kAccepted,      // a new job
  kFound,         // request_id was used before, for the same key
  kConflict,      // request_id was used before, for another key: nothing was changed
  kQueueFull,     // max_queued is reached: nothing was changed
  kOwnQueueFull,  // max_queued_of_owner is reached: nothing was changed
};

struct Submitted {
  SubmitOutcome outcome = SubmitOutcome::kAccepted;
  JobRecord job;  // of kAccepted and kFound; the job in the way, of kConflict
};

// A claim as those name it that hold it.
struct ClaimRef {
  std::int64_t task = 0;
  std::uint32_t attempt = 0;  // from 1
};

struct Claim {
  ClaimRef ref{};
  std::string key{};
  std::string owner{};  // of the job that made the task
  std::string request{};
  std::uint64_t estimate = 0;
  std::string job_id{};     // of the job that made the task
  std::string trace{};      // of its submission
  std::uint32_t tries = 0;  // attempts that count, this one included
};

enum class Held {
  kHeld,
  kLost,  // another has it, or no job waits for it any more: stop working on it
};

struct StoredChunk {
  std::string sha256;  // 32 bytes, of the bytes as stored
  std::uint64_t bytes = 0;
};

struct StoredMesh {
  std::string summary;
  std::string brief;                // what every look at a job shows of the summary; short
  std::vector<StoredChunk> chunks;  // in order
};

struct ListQuery {
  std::string owner{};
  std::vector<JobState> states{};  // empty: all
  std::size_t limit = 100;
  std::string before{};  // jobs older than this id; empty: from the youngest
};

// When a lost task is tried again, and how often.
struct RetryPolicy {
  std::uint32_t max_attempts = 3;
  std::chrono::milliseconds first_delay{1000};  // doubled with every attempt, at most a minute
  std::string error{};                          // of the jobs whose task has used up its attempts
};

// From the end of this attempt to the next.
constexpr std::chrono::milliseconds delay_after(const RetryPolicy& policy, std::uint32_t attempt) {
  constexpr std::chrono::milliseconds kMinute{60'000};
  constexpr std::uint32_t kMostDoublings = 16;
  const std::uint32_t doublings = std::min(std::max(attempt, 1u) - 1, kMostDoublings);
  return std::min(policy.first_delay * (std::int64_t{1} << doublings), kMinute);
}

struct Reaped {
  std::uint64_t requeued = 0;
  std::uint64_t failed = 0;  // tasks that had used up their attempts
};

struct KeepPolicy {
  std::chrono::seconds age{0};  // jobs that ended, and meshes that nobody asked for, for so long
  std::uint64_t bytes = 0;      // of chunks; over it the meshes go that were longest not asked for
  // A chunk that no mesh refers to may be part of one that is being made: it stays for so long.
  std::chrono::seconds loose_age{3600};
};

struct Collected {
  std::uint64_t jobs = 0;
  std::uint64_t meshes = 0;
  std::uint64_t chunks = 0;
  std::uint64_t bytes = 0;  // of chunks

  bool operator==(const Collected&) const = default;
};

struct StoreFigures {
  std::uint64_t queued = 0;  // tasks
  std::uint64_t running = 0;
  std::uint64_t queued_estimate = 0;
  double oldest_queued_seconds = 0;
  std::uint64_t meshes = 0;
  std::uint64_t chunk_bytes = 0;
};

class JobStore {
 public:
  virtual ~JobStore() = default;

  // --- for clients ---
  virtual StoreResult<Submitted> submit(const Submission& submission) = 0;
  // Nothing if the owner has no such job; the same below.
  virtual StoreResult<std::optional<JobRecord>> get(const std::string& owner,
                                                    const std::string& id) = 0;
  // The youngest first.
  virtual StoreResult<std::vector<JobRecord>> list(const ListQuery& query) = 0;
  // As it is afterwards: cancelled, or as it had ended. The last job of a task takes the task
  // along.
  virtual StoreResult<std::optional<JobRecord>> cancel(const std::string& owner,
                                                       const std::string& id) = 0;
  // The job as it was; it is still there where its state is not final.
  virtual StoreResult<std::optional<JobRecord>> remove(const std::string& owner,
                                                       const std::string& id) = 0;
  // Nothing where it is not kept. Counts as asking for it.
  virtual StoreResult<std::optional<StoredMesh>> mesh(const std::string& key) = 0;
  virtual StoreResult<std::optional<std::string>> chunk(const std::string& sha256) = 0;

  // --- for workers ---
  // Of the tasks that are due and of at most this estimate: the owner with the fewest claims comes
  // first, then the owner who was served longest ago, then the oldest task. Nothing if there is
  // none.
  virtual StoreResult<std::optional<Claim>> claim(const std::string& worker,
                                                  std::chrono::milliseconds lease,
                                                  std::uint64_t max_estimate) = 0;
  virtual StoreResult<Held> renew(const ClaimRef& claim, std::chrono::milliseconds lease,
                                  const std::string& progress) = 0;
  // Does nothing if the chunk is there. `sha256` is of `bytes`.
  virtual StoreResult<void> put_chunk(const std::string& sha256, std::string_view bytes) = 0;
  // All jobs of the task have succeeded. kUnavailable if a chunk is missing.
  virtual StoreResult<Held> finish(const ClaimRef& claim, const StoredMesh& mesh) = 0;
  // All jobs of the task have failed.
  virtual StoreResult<Held> fail(const ClaimRef& claim, const std::string& error) = 0;
  // Back into the queue, due after `delay`. Where `counts` is false the attempt was none: the
  // server stops, it is not the task's fault.
  virtual StoreResult<Held> release(const ClaimRef& claim, std::chrono::milliseconds delay,
                                    bool counts) = 0;

  // --- for the house-keeping of any server, at any time ---
  virtual StoreResult<Reaped> reap(const RetryPolicy& policy) = 0;
  virtual StoreResult<Collected> collect(const KeepPolicy& policy) = 0;
  virtual StoreResult<StoreFigures> figures() = 0;

  // Called, on any thread, when something may have changed: a job, its progress, a task to claim. A
  // hint: changes go unannounced if a connection is down, and come without one. Set once, before
  // the store is used by others; may be called until the store is destroyed.
  virtual void on_change(std::function<void()> listener) = 0;
};

}  // namespace weft::server
