// SPDX-License-Identifier: Apache-2.0
// One worker's try at a job: the engine makes the mesh, its chunks go to the store one by one, and
// the store settles the outcome. Whatever happens, the claim ends in one of three ways: settled
// (finished or failed), released for another try, or lost to the worker that has it now.
//
// Thread-safety: one thread calls `run`; meanwhile any thread may call the other functions.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "server/observe/log.h"
#include "server/observe/metrics.h"
#include "server/run/engine_call.h"
#include "server/run/mutex.h"
#include "server/run/run_queue.h"
#include "server/store/job_store.h"
#include "server/wire/job_wire.h"
#include "server/wire/limits.h"
#include "weft/run.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::server {

// Shared by all runs of a server; must outlive them.
struct RunEnvironment {
  EngineFn engine;
  ThreadPool& pool;  // where they compute
  JobStore& store;
  Limits limits;
  RetryPolicy retry;
  Metrics& metrics;
  Logger log;
};

class Attempt final : private ChunkSink {
 public:
  // A claim whose request was not stored by a server fails with kStoreBroken. The slot, where it
  // works, has admitted it, and outlives it.
  Attempt(const RunEnvironment& environment, Claim claim, RunQueue::Slot& slot);

  // Returns once the claim has ended.
  void run();

  // Bytes that the run may take now.
  std::uint64_t reserved_bytes() const { return slot_.memory().bytes(); }

  // Stops because the server stops: the task goes back into the queue, as if it had not begun.
  void stop();

  // Renews the lease, with the progress. Does nothing if the run has made no progress for as long
  // as a lease: another worker then takes it. One thread at a time may call it.
  void renew(std::chrono::milliseconds lease);

 private:
  using Clock = Run::Clock;

  tl::expected<void, Failure> make_mesh();
  bool accept(Chunk&& chunk) override;
  void settle(const Failure& failure);
  void lose();
  // Repeats a call of the store while this is unavailable, until the run must end or a time limit
  // is reached.
  template <class F>
  std::invoke_result_t<F> retry_while_unavailable(F&& call);
  bool pause(std::chrono::milliseconds at_most);
  void log_end(std::string_view outcome, std::string_view reason) const;

  const RunEnvironment& environment_;
  Claim claim_;              // its request is parsed, and empty, once this is made
  const std::string label_;  // of its lines in the log
  tl::expected<ReadRequest, Failure> request_;
  RunQueue::Slot& slot_;
  const std::uint64_t besides_;  // bytes of memory, beside the engine's
  const Clock::time_point began_ = Clock::now();
  const double max_seconds_;  // of work
  const std::uint32_t threads_;
  Run run_;
  std::atomic<std::uint64_t> chunks_stored_{0};

  // Used only by the running thread.
  v1::GenerateMeshResponse chunk_message_;  // kept for the memory of its arrays
  StoredMesh mesh_;
  std::uint64_t bytes_ = 0;
  std::optional<StoreError> store_error_;  // that stopped the engine

  // Used only by the renewing thread.
  std::uint64_t last_pulse_ = 0;
  Clock::time_point last_moved_ = began_;
  v1::Progress progress_;

  Mutex mutex_;
  bool lost_ ABSL_GUARDED_BY(mutex_) = false;
  bool stopping_ ABSL_GUARDED_BY(mutex_) = false;
  std::condition_variable ended_;
};

}  // namespace weft::server
