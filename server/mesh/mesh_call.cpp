// SPDX-License-Identifier: Apache-2.0
#include "server/mesh/mesh_call.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <new>
#include <utility>

#include "server/run/memory_estimate.h"
#include "server/wire/translate.h"

namespace weft::server {
namespace {

using Seconds = std::chrono::duration<double>;

grpc::ByteBuffer accepted_message(const std::string& id, std::uint32_t threads) {
  v1::GenerateMeshResponse message;
  v1::Accepted& accepted = *message.mutable_accepted();
  accepted.set_job_id(id);
  accepted.set_engine_version(std::string(kEngineVersion));
  accepted.set_threads(threads);
  return serialize(message);
}

std::string queued_line(const std::string& id, const std::string& caller,
                        const v1::Domain& domain) {
  return fmt::format(
      "event=call_queued call={} {} method=GenerateMesh points={} segments={} seeds={}", id, caller,
      domain.points_size() / 2, domain.segments_size() / 2,
      domain.holes_size() / 2 + domain.regions_size());
}

// The messages of a cached mesh share its bytes, so all of them may be queued.
constexpr ChunkQueue::Bounds kNoBounds{std::numeric_limits<std::size_t>::max(),
                                       std::numeric_limits<std::size_t>::max()};

// How long a run waits for its reader before it leaves its slot.
constexpr std::chrono::milliseconds kMaxWaitInSlot{5};

}  // namespace

MeshCall::MeshCall(const CallEnvironment& environment, AdmittedCall& call, std::string id,
                   const v1::GenerateMeshRequest& request, MeshRequest converted,
                   CacheLookup cached)
    : MessageStream(
          call.call,
          accepted_message(id, to_threads(request.threads(), environment.pool.threads())),
          cached.hit ? kNoBounds : ChunkQueue::Bounds::of_bytes(environment.limits.stream_buffer)),
      environment_(environment),
      id_(std::move(id)),
      caller_(call.caller),
      caller_fields_(log_fields(caller_)),
      call_deadline_(call.call->context()->deadline()),
      max_seconds_(to_seconds(request.budget(), environment.limits)),
      threads_(to_threads(request.threads(), environment.pool.threads())),
      first_chunk_(request.first_chunk()),
      wants_quadtree_(request.want_quadtree()),
      cached_(std::move(cached)),
      largest_field_(largest_field(request)),
      queued_line_(queued_line(id_, caller_fields_, request.domain())),
      pass_(std::exchange(call.pass, std::nullopt)),
      budget_(to_budget(request.budget(), environment.limits)),
      run_(budget_),
      request_memory_(std::move(call.memory)),
      request_(std::move(converted)) {}

void MeshCall::start() noexcept try {
  if (cached_.hit) {
    log_queued();
    send_cached();
    return;
  }
  const Estimate expected = estimate(request_, budget_);
  const std::uint64_t besides = bytes_besides(environment_.limits);
  const auto work = [self = shared_from_this()](RunQueue::Slot& slot) { self->run(slot); };
  auto refusal = environment_.queue.push({.client = caller_.client(),
                                          .estimate = expected.bytes + besides,
                                          .owner = this,
                                          .least = expected.least_bytes + besides,
                                          .input = request_memory_.of_all.bytes()},
                                         work);
  if (refusal) {
    if (refusal->reason == Reason::kLimitExceeded) refusal->field = largest_field_;
    return fail(*refusal);
  }
  log_queued();
  pump();
} catch (const std::bad_alloc&) {
  kill();
}

void MeshCall::log_queued() {
  std::call_once(queued_, [this] { environment_.log->info("{}", queued_line_); });
}

void MeshCall::send_cached() {
  const FinishedMesh& mesh = *cached_.hit;
  if (auto failure = check_first_chunk(mesh.summary)) return fail(*failure);
  for (std::size_t i = first_chunk_; i < mesh.chunks.size(); ++i) {
    if (!send(mesh.chunks[i])) return;
    sent(mesh.chunks[i].Length());
  }
  succeed(mesh.summary);
}

void MeshCall::stop(StopCause cause) {
  fail(failure_of_cause(cause));  // before the engine notices it and reports a cancellation
  run_.cancel();
  environment_.queue.remove(this);
  if (cause == StopCause::kReaderStalled) kill();
}

void MeshCall::tick(Clock::time_point now) {
  std::optional<Clock::time_point> deadline;
  {
    std::lock_guard lock(mutex_);
    deadline = work_deadline_;
  }
  if (auto slowness = too_slow(now, environment_.patience)) {
    fail({Reason::kReaderStalled, "", *std::move(slowness)});
    stop(StopCause::kReaderStalled);
  } else if (deadline && now >= *deadline) {
    stop(StopCause::kTimeUp);
  } else if (!cached_.hit) {
    offer(progress_message(now));
  }
}

// Without memory for an error, the client sees that the call was cancelled.
void MeshCall::run(RunQueue::Slot& slot) noexcept try {
  log_queued();
  if (run_.poll()) return;  // stopped in the meantime, which ended the call
  const tl::expected<Summary, Failure> outcome = work(slot);
  if (outcome) {
    succeed(*outcome);
  } else if (outcome.error().reason == Reason::kDeadlineExceeded) {
    fail(failure_of_cause(StopCause::kTimeUp));
  } else {
    fail(outcome.error());
  }
  keep_unread(slot);
} catch (const std::bad_alloc&) {
  kill();
}

// A mesh may wait for its reader for as long as that reads at all.
void MeshCall::keep_unread(RunQueue::Slot& slot) {
  MemoryBudget::Reservation& memory = slot.memory();
  memory.shrink_to(std::min<std::uint64_t>(bytes_, bytes_besides(environment_.limits)));
  memory.reclassify_as_output();
  std::lock_guard lock(mutex_);
  if (!over_) std::swap(unread_, memory);
}

// The memory is released first: once the call is forgotten, the server need not wait for it, and
// the queue that the budget notifies may be gone.
void MeshCall::ended_for_good() {
  {
    MemoryBudget::Reservation released;
    std::lock_guard lock(mutex_);
    over_ = true;
    std::swap(released, unread_);
  }
  environment_.forget(*this);  // which may destroy this
}

tl::expected<Summary, Failure> MeshCall::work(RunQueue::Slot& slot) {
  slot_ = &slot;
  const Seconds until_call_deadline = call_deadline_ - std::chrono::system_clock::now();
  const Clock::time_point deadline =
      seconds_from_now(std::min(max_seconds_, until_call_deadline.count()));
  {
    std::lock_guard lock(mutex_);
    work_deadline_ = deadline;
  }
  const double waited = Seconds(Clock::now() - admitted_).count();
  environment_.metrics.waited(waited);
  environment_.log->info("event=call_started call={} {} waited_seconds={:.3f}", id_, caller_fields_,
                         waited);
  if (!cached_.key.empty() && first_chunk_ == 0) recording_.emplace(environment_.cache.largest());
  auto summary = call_engine(environment_.engine, std::move(request_), *this,
                             {.run = run_,
                              .slot = slot,
                              .besides = bytes_besides(environment_.limits),
                              .deadline = deadline,
                              .pool = environment_.pool,
                              .threads = threads_});
  request_memory_ = {};
  if (!summary) return summary;
  if (recording_) environment_.cache.keep(cached_.key, std::move(*recording_).finish(*summary));
  environment_.metrics.refined(summary->engine_seconds);
  if (auto failure = check_first_chunk(*summary)) return tl::unexpected(*failure);
  return summary;
}

std::optional<Failure> MeshCall::check_first_chunk(const Summary& summary) const {
  if (first_chunk_ <= summary.chunks) return std::nullopt;
  return Failure{
      Reason::kChunkOutOfRange, "first_chunk",
      fmt::format("first_chunk is {}, but the mesh has {} chunks", first_chunk_, summary.chunks)};
}

void MeshCall::succeed(const Summary& summary) {
  v1::GenerateMeshResponse message;
  *message.mutable_summary() = to_wire(summary, threads_);
  message.mutable_summary()->set_cached(cached_.hit != nullptr);
  if (wants_quadtree_) add_quadtree(summary, *message.mutable_summary());
  grpc::ByteBuffer last = serialize(message);
  if (when_there_is_room(last.Length(), [&] { return finish(std::move(last)); }))
    log_end(grpc::StatusCode::OK, "-");
}

void MeshCall::fail(const Failure& failure) {
  if (abort(to_status(failure, id_))) log_end(code_of(failure.reason), row_of(failure.reason).name);
}

Failure MeshCall::failure_of_cause(StopCause cause) const {
  const bool call_is_late = std::chrono::system_clock::now() >= call_deadline_;
  switch (cause) {
    case StopCause::kClientGone:
      if (call_is_late) break;
      return {Reason::kCancelled, "", "the client cancelled the call"};
    case StopCause::kTimeUp:
      if (call_is_late) break;
      return {Reason::kDeadlineExceeded, "",
              fmt::format("the run took {} s, which is its limit", max_seconds_)};
    case StopCause::kReaderStalled:
      return {Reason::kReaderStalled, "", "the client reads too slowly"};
    case StopCause::kStopping:
      return {Reason::kStopping, "", "the server is stopping"};
    case StopCause::kTokenRevoked:
      return token_revoked();
  }
  return {Reason::kDeadlineExceeded, "", "the call's deadline passed"};
}

// Calls `send`, which waits until the stream has room for a message of `bytes` bytes. A run that
// waits for its reader leaves its slot to another run.
template <class Send>
bool MeshCall::when_there_is_room(std::size_t bytes, Send&& send) {
  if (has_room_within(kMaxWaitInSlot, bytes)) return send();
  const RunQueue::Pause pause(*slot_);
  return send();
}

bool MeshCall::accept(Chunk&& chunk) {
  environment_.metrics.triangles_made(chunk.triangles.size() / 3);
  if (chunk.index < first_chunk_) return true;
  to_wire(chunk, *chunk_message_.mutable_chunk());
  grpc::ByteBuffer bytes = serialize(chunk_message_);
  const std::size_t length = bytes.Length();
  if (recording_) recording_->add(bytes);
  if (!when_there_is_room(length, [&] { return send(std::move(bytes)); })) return false;
  sent(length);
  return true;
}

void MeshCall::sent(std::size_t bytes) {
  environment_.metrics.chunk_sent(bytes);
  if (chunks_++ == 0) environment_.metrics.first_chunk(Seconds(Clock::now() - admitted_).count());
  bytes_ += bytes;
}

grpc::ByteBuffer MeshCall::progress_message(Clock::time_point now) {
  {
    std::lock_guard lock(mutex_);
    if (work_deadline_) progress_.set_stage(std::max(progress_.stage(), v1::STAGE_TRIANGULATE));
  }
  write_progress(run_.progress(), Seconds(now - admitted_).count(), progress_);
  v1::GenerateMeshResponse message;
  *message.mutable_progress() = progress_;
  return serialize(message);
}

void MeshCall::log_end(grpc::StatusCode code, std::string_view reason) const {
  const double seconds = Seconds(Clock::now() - admitted_).count();
  const std::uint64_t triangles =
      cached_.hit ? cached_.hit->summary.triangles : run_.progress().triangles;
  environment_.metrics.call_ended("GenerateMesh", code, seconds);
  if (code != grpc::StatusCode::OK && !environment_.may_log_failure()) return;
  environment_.log->info(
      "event=call_ended call={} {} method=GenerateMesh status={} reason={} cached={} "
      "triangles={} chunks={} bytes={} seconds={:.3f}",
      id_, caller_fields_, code_name(code), reason, cached_.hit ? "yes" : "no", triangles,
      chunks_.load(), bytes_.load(), seconds);
}

}  // namespace weft::server
