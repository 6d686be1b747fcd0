// SPDX-License-Identifier: Apache-2.0
// One GenerateMesh call that was admitted: it waits in the job queue, runs the engine on a worker
// thread, hands the chunks to its stream, and ends exactly once, whatever stops it. One whose mesh
// is at hand does none of that but the last.
//
// What can stop it, and what its call then ends with: see StopCause. The first cause wins, and the
// call ends at once; the engine notices within 50 ms.
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

#include "engine/arena.h"
#include "server/caller.h"
#include "server/drain.h"
#include "server/engine_call.h"
#include "server/errors.h"
#include "server/job_queue.h"
#include "server/limits.h"
#include "server/log.h"
#include "server/mesh_cache.h"
#include "server/message_stream.h"
#include "server/metrics.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::server {

enum class StopCause {
  kClientGone,     // CANCELLED, or DEADLINE_EXCEEDED where the call's deadline has passed
  kTimeUp,         // DEADLINE_EXCEEDED
  kReaderStalled,  // CANCELLED
  kStopping,       // UNAVAILABLE
};

// What all jobs share; outlives them.
struct JobEnvironment {
  EngineFn engine;
  Arena& arena;  // where they compute
  Limits limits;
  std::chrono::steady_clock::duration stall_timeout;
  Logger log;
  JobQueue& queue;
  Metrics& metrics;
  MeshCache& cache;
  std::function<void(MessageStream&)> forget;  // drops the owner's pointer to the job
};

// Where a job's mesh comes from and goes to: the cache, by its key.
struct Origin {
  std::string key{};                              // empty: it is not to be kept
  std::shared_ptr<const FinishedMesh> at_hand{};  // null: it is to be made
};

class MeshJob final : public MessageStream,
                      public JobQueue::Job,
                      public std::enable_shared_from_this<MeshJob>,
                      private ChunkSink {
 public:
  MeshJob(const JobEnvironment& environment, grpc::CallbackServerContext* context, Caller caller,
          std::string id, std::unique_ptr<v1::GenerateMeshRequest> request, DrainGate::Pass pass,
          Origin origin);

  // Joins the queue, or ends with QUEUE_FULL; sends what is at hand. Call once.
  void start() noexcept;

  void stop(StopCause cause);

  // Called a few times a second: sends progress, ends the job at its deadline, cuts off a client
  // that reads nothing.
  void tick(Clock::time_point now);

 private:
  void run(JobQueue::Lane lane) noexcept override;
  void send_what_is_at_hand();
  tl::expected<Summary, Failure> work(JobQueue::Lane lane);
  std::optional<Failure> check_first_chunk(const Summary& summary) const;
  // Counts a chunk whose message was taken by the stream.
  void sent(std::size_t bytes, std::size_t triangles);
  // Of these, the first decides how the call ends, and logs it.
  void succeed(const Summary& summary);
  void fail(const Failure& failure);

  Failure failure_of_cause(StopCause cause) const;
  grpc::ByteBuffer progress_message(Clock::time_point now);
  void tell_end(grpc::StatusCode code, std::string_view reason) const;

  bool accept(Chunk&& chunk) override;
  void client_gone() override { stop(StopCause::kClientGone); }
  void done() override { environment_.forget(*this); }

  const JobEnvironment& environment_;
  const std::string id_;
  const std::string caller_;  // as a line of the log tells it
  const std::string client_;  // has turns of its own
  const std::chrono::system_clock::time_point call_deadline_;
  const double max_seconds_;  // of work
  const std::uint32_t threads_;
  const std::uint32_t first_chunk_;  // those before it are not sent
  const bool wants_quadtree_;
  const Origin origin_;
  const Clock::time_point admitted_ = Clock::now();
  const DrainGate::Pass pass_;
  ExecutionContext context_;
  std::atomic<std::uint64_t> chunks_{0};  // handed to the stream
  std::atomic<std::uint64_t> bytes_{0};

  // The worker's own.
  std::unique_ptr<v1::GenerateMeshRequest> request_;
  v1::GenerateMeshResponse chunk_message_;  // kept for the memory of its arrays
  std::optional<MeshRecording> recording_;

  // The ticking thread's own: what was last told, since progress never goes back.
  v1::Progress told_;

  mutable std::mutex mutex_;                        // guards the one below
  std::optional<Clock::time_point> work_deadline_;  // set when the job begins
};

}  // namespace weft::server
