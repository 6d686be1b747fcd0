// SPDX-License-Identifier: Apache-2.0
// One task at work: the engine makes the mesh, its chunks go to the store one by one, and the store
// settles what became of it. Whatever happens, the claim ends in one of three ways: settled
// (finished or failed), released for another try, or lost to whoever has it now.
//
// Thread-safety: `run` is for one thread; all the others may be called from any thread meanwhile.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "engine/base/arena.h"
#include "server/admission/memory_gate.h"
#include "server/admission/run_memory.h"
#include "server/mesh/engine_call.h"
#include "server/observe/log.h"
#include "server/observe/metrics.h"
#include "server/store/job_store.h"
#include "server/wire/limits.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::server {

// What all runs of a server share; outlives them.
struct RunEnvironment {
  EngineFn engine;
  Arena& arena;  // where they compute
  JobStore& store;
  Limits limits;
  RetryPolicy retry;
  Metrics& metrics;
  Logger log;
};

class Attempt final : private ChunkSink {
 public:
  // A claim whose request no server has stored fails with kStoreBroken.
  // `share` is what the claim was admitted with; it goes back when the run ends.
  // A light run computes on its own thread, not in the arena, where it would wait for the turns of
  // heavy ones. Once it turns out heavy it calls `leave_light_lane`, which may wait. Null: it is
  // heavy.
  using LeaveLightLane = std::function<void(MemoryGate::Share&, const ExecutionContext&)>;
  Attempt(const RunEnvironment& environment, Claim claim, MemoryGate::Share share,
          LeaveLightLane leave_light_lane);

  // Returns once the claim has ended.
  void run();

  // Bytes that the run may take now.
  std::uint64_t share_bytes() const { return share_.bytes(); }

  // The server stops: the task goes back into the queue, as if it had not been begun.
  void stop();

  // Renews the lease, with the progress. For a run that has not moved for as long as a lease it
  // does nothing: what hangs is left to another worker. Of one thread at a time.
  void renew(std::chrono::milliseconds lease);

 private:
  using Clock = ExecutionContext::Clock;

  tl::expected<void, Failure> make_mesh();
  bool accept(Chunk&& chunk) override;
  void settle(const Failure& failure);
  void lose();
  // Calls the store again while it is unavailable, until the run is to end or patience does.
  template <class F>
  std::invoke_result_t<F> insist(F&& call);
  bool pause(std::chrono::milliseconds at_most);
  void log_end(std::string_view outcome, std::string_view reason) const;

  const RunEnvironment& environment_;
  Claim claim_;              // its request is parsed, and empty, once this is made
  const std::string label_;  // of its lines in the log
  tl::expected<std::unique_ptr<v1::GenerateMeshRequest>, Failure> request_;
  MemoryGate::Share share_;
  RunMemory memory_;
  const Clock::time_point began_ = Clock::now();
  const double max_seconds_;  // of work
  const std::uint32_t threads_;
  ExecutionContext context_;
  std::atomic<std::uint64_t> chunks_stored_{0};

  // The running thread's own.
  v1::GenerateMeshResponse chunk_message_;  // kept for the memory of its arrays
  StoredMesh mesh_;
  std::uint64_t bytes_ = 0;
  std::optional<StoreError> store_error_;  // that stopped the engine

  // The renewing thread's own.
  std::uint64_t last_pulse_ = 0;
  Clock::time_point last_moved_ = began_;
  v1::Progress told_;

  std::mutex mutex_;  // guards the two below
  bool lost_ = false;
  bool stopping_ = false;
  std::condition_variable ended_;
};

}  // namespace weft::server
