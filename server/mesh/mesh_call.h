// SPDX-License-Identifier: Apache-2.0
// One GenerateMesh call that was admitted: it waits in the queue, runs the engine on a worker
// thread, sends the chunks on its stream, and ends exactly once, whatever stops it. A call whose
// mesh is cached only sends it and ends.
//
// StopCause lists what can stop a call, and with which status it then ends. The first cause wins,
// and the call ends at once; the engine notices within 50 ms.
//
// Thread-safety: `stop` and `tick` may be called from any thread at any time.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "server/admission/admission.h"
#include "server/mesh/mesh_cache.h"
#include "server/net/caller.h"
#include "server/net/message_stream.h"
#include "server/observe/log.h"
#include "server/observe/metrics.h"
#include "server/run/engine_call.h"
#include "server/run/run_queue.h"
#include "server/wire/errors.h"
#include "server/wire/limits.h"
#include "weft/run.h"
#include "weft/v1/mesh_service.pb.h"
#include "weft/weft.h"

namespace weft::server {

enum class StopCause {
  kClientGone,     // CANCELLED, or DEADLINE_EXCEEDED where the call's deadline has passed
  kTimeUp,         // DEADLINE_EXCEEDED
  kReaderStalled,  // CANCELLED
  kStopping,       // UNAVAILABLE
  kTokenRevoked,   // UNAUTHENTICATED
};

// Shared by all calls; outlives them.
struct CallEnvironment {
  EngineFn engine;
  ThreadPool& pool;  // of heavy runs
  Limits limits;
  ReaderPatience patience;
  Logger log;
  RunQueue& queue;
  Metrics& metrics;
  MeshCache& cache;
  std::function<void(MessageStream&)> forget;  // drops the owner's pointer to the call
  std::function<bool()> may_log_failure;       // see Admission
};

// What the cache of meshes has for a call.
struct CacheLookup {
  std::string key{};                          // empty: the mesh is not to be kept
  std::shared_ptr<const FinishedMesh> hit{};  // null: the mesh is to be made
};

class MeshCall final : public MessageStream,
                       public std::enable_shared_from_this<MeshCall>,
                       private ChunkSink {
 public:
  // Takes all parts of the call except its bytes. `converted` is the request in the engine's form;
  // empty if the mesh is cached.
  MeshCall(const CallEnvironment& environment, AdmittedCall& call, std::string id,
           const v1::GenerateMeshRequest& request, MeshRequest converted, CacheLookup cached);

  // Joins the queue, or ends with QUEUE_FULL; sends the mesh if it is cached. Call once.
  void start() noexcept;

  void stop(StopCause cause);

  const Caller& caller() const { return caller_; }
  void revoke() { stop(StopCause::kTokenRevoked); }

  // Called a few times a second: sends progress, ends the call at its deadline, cuts off a client
  // that reads nothing.
  void tick(Clock::time_point now);

 private:
  void run(RunQueue::Slot& slot) noexcept;
  // Logs once that the call is in the queue: its run may begin before `start` returns.
  void log_queued();
  void send_cached();
  tl::expected<Summary, Failure> work(RunQueue::Slot& slot);
  std::optional<Failure> check_first_chunk(const Summary& summary) const;
  // Counts a chunk whose message the stream accepted.
  void sent(std::size_t bytes);
  template <class Send>
  bool when_there_is_room(std::size_t bytes, Send&& send);
  // The first of these that is called decides how the call ends, and logs it.
  void succeed(const Summary& summary);
  void fail(const Failure& failure);

  Failure failure_of_cause(StopCause cause) const;
  grpc::ByteBuffer progress_message(Clock::time_point now);
  void log_end(grpc::StatusCode code, std::string_view reason) const;

  bool accept(Chunk&& chunk) override;
  void client_gone() override { stop(StopCause::kClientGone); }
  void ended_for_good() override;
  void keep_unread(RunQueue::Slot& slot);

  const CallEnvironment& environment_;
  const std::string id_;
  const Caller caller_;
  const std::string caller_fields_;  // of the log
  const std::chrono::system_clock::time_point call_deadline_;
  const double max_seconds_;  // of the run
  const std::uint32_t threads_;
  const std::uint32_t first_chunk_;  // those before it are not sent
  const bool wants_quadtree_;
  const CacheLookup cached_;
  const char* const largest_field_;
  const std::string queued_line_;  // of the log
  std::once_flag queued_;
  RunQueue::Slot* slot_ = nullptr;  // used only by the worker
  const Clock::time_point admitted_ = Clock::now();
  const std::optional<DrainGate::Pass> pass_;
  const Budget budget_;
  Run run_;
  std::atomic<std::uint64_t> chunks_{0};  // handed to the stream
  std::atomic<std::uint64_t> bytes_{0};

  RequestMemory request_memory_;  // until the run has ended

  // Used only by the worker.
  MeshRequest request_;
  v1::GenerateMeshResponse chunk_message_;  // kept for the memory of its arrays
  std::optional<MeshRecording> recording_;

  // Used only by the ticking thread: the progress that was sent last, because it never goes back.
  v1::Progress progress_;

  mutable std::mutex mutex_;                        // guards the three below
  MemoryBudget::Reservation unread_;                // of messages that wait for the reader
  bool over_ = false;                               // the call has ended for good
  std::optional<Clock::time_point> work_deadline_;  // set when the run begins
};

}  // namespace weft::server
