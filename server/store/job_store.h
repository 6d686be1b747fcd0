// SPDX-License-Identifier: Apache-2.0
// The store of jobs, of the work still to be done for them, and of finished meshes; it outlives a
// server. There are two implementations, in one file (sqlite_store.h) and for several servers
// (postgres_store.h); one suite of tests checks the laws below on both.
//
// Three things are kept apart:
//   job    what one client asked for, and its outcome; lives until deleted or collected
//   task   a mesh to be made, for one or more jobs; lives while any of them waits for it
//   mesh   a finished mesh: a summary and chunks, each named by its SHA-256
//
// The store does not interpret requests, progress, errors, summaries and chunks: they are bytes.
// Disks and memories lose bits: who reads a chunk compares it with its SHA-256, and calls
// `drop_damaged` if it is another; the mesh is then made anew for the next who asks.
// `key` names a mesh: 32 bytes, a digest of the request and the engine version, and of the owner if
// clients share nothing. Jobs of the same key share a task, and find the mesh once it is made.
//
// A job may have a callback, which tells of its end. Once the job has ended, the callback is
// pending until it is settled; whoever claims it has it for a lease, and then it is due again.
//
// Laws, whatever fails and whenever:
//   1. A job whose submission has returned exists, and reaches exactly one final state.
//   2. A task is held by at most one claim. A claim is a lease: if it is not renewed in time,
//      `reap` takes it away, and the next claim has a higher attempt. The holder of an older claim
//      can change nothing any more: `renew`, `finish`, `fail` and `release` return kLost. A claim
//      that has settled its task may settle it the same way again, which returns kHeld: so a caller
//      that got no reply can repeat the call.
//   3. A mesh is complete: `finish` settles the mesh, the task and all jobs in one transaction, and
//      only if every chunk is stored.
//   4. No transaction is open between two calls.
//   5. Tasks are claimed in the order in which they were made, whatever the clock says. If it was
//      set back, `reap` shortens leases and pauses that could not have been given now.
//   6. The callback of a job that ended is claimed again until it is settled as delivered or
//      failed, or its owner removes the job. At most one claim of it is valid, as of a task.
//
// Errors: see StoreError. Every function may block on the disk or the network, so none may be
// called on a thread of gRPC. Thread-safety: every function may be called from any thread.
//
//   auto store = SqliteStore::open({.folder = "/var/lib/weft"});
//   if (!store) return complain(store.error());
//   auto job = (*store)->submit({.owner = "ann", .key = key, .request = bytes});
//   auto claim = (*store)->claim("worker-1", std::chrono::seconds(30), 1 << 30);
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

// What became of a callback. Its numbers are stored.
enum class CallbackState { kNone, kPending, kClaimed, kDelivered, kFailed };

struct Callback {
  std::string url{};    // empty: none
  std::string place{};  // HOST:PORT of the URL, by which claims are kept from a place
  CallbackState state = CallbackState::kNone;
  std::uint32_t attempts = 0;
  std::string error{};  // of the last attempt; empty if it is delivered
};

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
  std::optional<std::int64_t> task;  // that it waits for; nullopt once it has ended
  std::string brief;                 // of its mesh; empty unless succeeded, and the mesh is kept
  Callback callback;                 // without its place
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
  // The job joins a task of its key only if that may use as much. Otherwise it makes a new task,
  // which later jobs join instead.
  WorkBudget budget{};
  std::string trace{};  // of the call, for the log of the worker
  // Make a mesh even if one is kept, and share no task. The new mesh replaces the kept one.
  bool no_cache = false;
  // Maximum waiting tasks of all owners; a job that joins a task is accepted nonetheless. Maximum
  // jobs of this owner that have not ended. Whoever finds a mesh needs no room.
  std::uint64_t max_queued = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t max_open_of_owner = std::numeric_limits<std::uint64_t>::max();
  // What is told of its end: a URL and its place. Maximum callbacks of this owner that are neither
  // delivered nor failed; a job without one is accepted nonetheless.
  Callback callback{};
  std::uint64_t max_callbacks_of_owner = std::numeric_limits<std::uint64_t>::max();
};

enum class SubmitOutcome {
  kAccepted,       // a new job
  kFound,          // request_id was used before, for the same key
  kConflict,       // request_id was used before, for another key: nothing was changed
  kQueueFull,      // max_queued is reached: nothing was changed
  kOwnerFull,      // max_open_of_owner is reached: nothing was changed
  kCallbacksFull,  // max_callbacks_of_owner is reached: nothing was changed
};

struct Submitted {
  SubmitOutcome outcome = SubmitOutcome::kAccepted;
  JobRecord job;  // for kAccepted and kFound; the existing job, for kConflict
};

// Names a claim, for its holder.
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
  kLost,  // another claim has the task, or no job waits for it any more: stop working on it
};

struct StoredChunk {
  std::string sha256;  // 32 bytes, of the bytes as stored
  std::uint64_t bytes = 0;
};

struct StoredMesh {
  std::string summary;
  std::string brief;                // the short part of the summary that is in every JobRecord
  std::vector<StoredChunk> chunks;  // in order
};

struct ListQuery {
  std::string owner{};
  std::vector<JobState> states{};  // empty: all
  std::size_t limit = 100;
  std::string before{};  // jobs older than this id; empty: from the youngest
};

// When and how often a lost task is tried again.
struct RetryPolicy {
  std::uint32_t max_attempts = 3;
  std::chrono::milliseconds first_delay{1000};  // doubled with every attempt, at most a minute
  std::string error{};                          // of jobs whose task has used up its attempts
  // No server of the store gives a longer lease.
  std::chrono::milliseconds longest_lease = std::chrono::hours(24 * 365);
};

inline constexpr std::chrono::milliseconds kLongestDelay{60'000};

// A callback is sent no later than this after an earlier attempt.
inline constexpr std::chrono::milliseconds kLongestCallbackDelay = std::chrono::hours(1);

// The time from the end of this attempt to the next.
constexpr std::chrono::milliseconds delay_after(const RetryPolicy& policy, std::uint32_t attempt) {
  constexpr std::uint32_t kMaxDoublings = 16;
  const std::uint32_t doublings = std::min(std::max(attempt, 1u) - 1, kMaxDoublings);
  return std::min(policy.first_delay * (std::int64_t{1} << doublings), kLongestDelay);
}

struct Reaped {
  std::uint64_t requeued = 0;
  std::uint64_t failed = 0;         // tasks without attempts left
  bool clock_was_set_back = false;  // a task was made later than now
};

struct KeepPolicy {
  std::chrono::seconds age{0};  // since a job's end, or since a mesh was last asked for
  std::uint64_t bytes = 0;      // of chunks; above it, least recently used meshes are removed
  // The part of `bytes` that the meshes of one owner may take: of the owner of the job for which
  // they were made. At least 1: any.
  double share_of_owner = 1;
  // Jobs of one owner that ended; above it, the oldest are removed.
  std::uint64_t jobs_of_owner = std::numeric_limits<std::uint64_t>::max();
  // How long a chunk is kept that no mesh refers to: it may be part of a mesh that is being made.
  std::chrono::seconds loose_age{3600};
};

struct Collected {
  std::uint64_t jobs = 0;
  std::uint64_t meshes = 0;
  std::uint64_t chunks = 0;
  std::uint64_t bytes = 0;  // of chunks

  bool operator==(const Collected&) const = default;
};

struct StoreStats {
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
  // Returns nullopt if the owner has no such job; the same below.
  virtual StoreResult<std::optional<JobRecord>> get(const std::string& owner,
                                                    const std::string& id) = 0;
  // The youngest first.
  virtual StoreResult<std::vector<JobRecord>> list(const ListQuery& query) = 0;
  // Returns the job as it is afterwards: cancelled, or as it had ended. With the last job of a
  // task, the task is removed.
  virtual StoreResult<std::optional<JobRecord>> cancel(const std::string& owner,
                                                       const std::string& id) = 0;
  // Returns the job as it was; it is not removed if its state is not final.
  virtual StoreResult<std::optional<JobRecord>> remove(const std::string& owner,
                                                       const std::string& id) = 0;
  // Returns nullopt if the mesh is not kept. Counts as asking for the mesh.
  virtual StoreResult<std::optional<StoredMesh>> mesh(const std::string& key) = 0;
  // Its bytes may have been damaged.
  virtual StoreResult<std::optional<std::string>> chunk(const std::string& sha256) = 0;
  // Deletes a chunk that is stored as these bytes, which are not those of its SHA-256, with the
  // meshes that it is part of; returns the number of meshes. It stays if it has other bytes by
  // now.
  virtual StoreResult<std::uint64_t> drop_damaged(const std::string& sha256,
                                                  std::string_view bytes) = 0;

  // --- for workers ---
  // Claims a task that is due and has at most this estimate; nullopt if there is none. The owner
  // with the fewest claims comes first, then the owner that was served longest ago, then the oldest
  // task. The owners in `except` get none.
  virtual StoreResult<std::optional<Claim>> claim(const std::string& worker,
                                                  std::chrono::milliseconds lease,
                                                  std::uint64_t max_estimate,
                                                  const std::vector<std::string>& except = {}) = 0;
  virtual StoreResult<Held> renew(const ClaimRef& claim, std::chrono::milliseconds lease,
                                  const std::string& progress) = 0;
  // Changes nothing if the chunk is stored already with these bytes; returns whether it was stored
  // with others, which it then replaces. `sha256` is that of `bytes`.
  virtual StoreResult<bool> put_chunk(const std::string& sha256, std::string_view bytes) = 0;
  // Settles all jobs of the task as succeeded. kUnavailable if a chunk is missing.
  virtual StoreResult<Held> finish(const ClaimRef& claim, const StoredMesh& mesh) = 0;
  // Settles all jobs of the task as failed.
  virtual StoreResult<Held> fail(const ClaimRef& claim, const std::string& error) = 0;
  // Puts the task back into the queue, due after `delay`, at most kLongestDelay. If `counts` is
  // false, the attempt does not count: the server stops, and the task is not at fault.
  virtual StoreResult<Held> release(const ClaimRef& claim, std::chrono::milliseconds delay,
                                    bool counts) = 0;

  // --- for callbacks ---
  // Claims a pending callback that is due, of a job that has ended, for at most
  // kLongestCallbackDelay: the one that is due for longest, but none of these owners and none to
  // these places. nullopt if there is none.
  virtual StoreResult<std::optional<JobRecord>> claim_callback(
      std::chrono::milliseconds lease, const std::vector<std::string>& except_owners,
      const std::vector<std::string>& except_places) = 0;
  // Settles the callback of a job as `claim_callback` returned it, as delivered or failed, with the
  // error in it; if it is pending, it is due again after `delay`, at most kLongestCallbackDelay.
  virtual StoreResult<Held> settle_callback(const JobRecord& claimed, CallbackState state,
                                            const std::string& error,
                                            std::chrono::milliseconds delay) = 0;

  // --- for the house-keeping of any server, at any time ---
  virtual StoreResult<Reaped> reap(const RetryPolicy& policy) = 0;
  virtual StoreResult<Collected> collect(const KeepPolicy& policy) = 0;
  virtual StoreResult<StoreStats> stats() = 0;

  // `listener` is called, on any thread, when something may have changed: a job, its progress, a
  // task to claim. It is a hint: changes are not announced while a connection is down, and it may
  // be called without a change. Set it once, before other threads use the store; it may be called
  // until the store is destroyed.
  virtual void on_change(std::function<void()> listener) = 0;
};

}  // namespace weft::server
