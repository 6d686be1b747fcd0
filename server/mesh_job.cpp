// SPDX-License-Identifier: Apache-2.0
#include "server/mesh_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "server/translate.h"
#include "server/weight.h"

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

// Messages of a mesh at hand share its bytes, and so may all be queued.
constexpr ChunkQueue::Bounds kNoBounds{std::numeric_limits<std::size_t>::max(),
                                       std::numeric_limits<std::size_t>::max()};

// Who is to have turns of his own: a caller with a name, or else a host.
std::string client_of(const Caller& caller) {
  if (!caller.name.empty()) return caller.name;
  return caller.peer.substr(0, caller.peer.rfind(':'));  // of ipv4:HOST:PORT and the like
}

}  // namespace

MeshJob::MeshJob(const JobEnvironment& environment, grpc::CallbackServerContext* context,
                 Caller caller, std::string id, std::unique_ptr<v1::GenerateMeshRequest> request,
                 DrainGate::Pass pass, Origin origin)
    : MessageStream(
          context,
          accepted_message(id, to_threads(request->threads(), environment.arena.threads())),
          origin.at_hand ? kNoBounds : ChunkQueue::Bounds{}),
      environment_(environment),
      id_(std::move(id)),
      caller_(log_fields(caller)),
      client_(client_of(caller)),
      call_deadline_(context->deadline()),
      max_seconds_(to_seconds(request->budget(), environment.limits)),
      threads_(to_threads(request->threads(), environment.arena.threads())),
      first_chunk_(request->first_chunk()),
      wants_quadtree_(request->want_quadtree()),
      origin_(std::move(origin)),
      pass_(std::move(pass)),
      context_(to_budget(request->budget(), environment.limits)),
      request_(std::move(request)) {}

void MeshJob::start() noexcept {
  const v1::Domain& domain = request_->domain();
  environment_.log->info(
      "event=job_queued job={} {} method=GenerateMesh points={} segments={} seeds={}", id_, caller_,
      domain.points_size() / 2, domain.segments_size() / 2,
      domain.holes_size() / 2 + domain.regions_size());
  if (origin_.at_hand) {
    send_what_is_at_hand();
    return;
  }
  if (environment_.queue.push(shared_from_this(),
                              {client_, expected_bytes(*request_, environment_.limits)})) {
    pump();
  } else {
    fail({Reason::kQueueFull, "",
          fmt::format("{} jobs wait already; this server's limit is {}",
                      environment_.queue.capacity(), environment_.queue.capacity())});
  }
}

void MeshJob::send_what_is_at_hand() {
  const FinishedMesh& mesh = *origin_.at_hand;
  request_.reset();
  if (auto failure = check_first_chunk(mesh.summary)) return fail(*failure);
  context_.add_triangles(static_cast<std::int64_t>(mesh.summary.triangles));
  for (std::size_t i = first_chunk_; i < mesh.chunks.size(); ++i) {
    if (!send(mesh.chunks[i].message)) return;
    sent(mesh.chunks[i].message.Length(), mesh.chunks[i].triangles);
  }
  succeed(mesh.summary);
}

void MeshJob::stop(StopCause cause) {
  fail(failure_of_cause(cause));  // before the engine learns of it, and calls itself cancelled
  context_.cancel();
  environment_.queue.remove(*this);
  if (cause == StopCause::kReaderStalled) kill();
}

void MeshJob::tick(Clock::time_point now) {
  std::optional<Clock::time_point> deadline;
  {
    std::lock_guard lock(mutex_);
    deadline = work_deadline_;
  }
  if (waiting_for_client(now) >= environment_.stall_timeout) {
    stop(StopCause::kReaderStalled);
  } else if (deadline && now >= *deadline) {
    stop(StopCause::kTimeUp);
  } else if (!origin_.at_hand) {
    offer(progress_message(now));
  }
}

void MeshJob::run(JobQueue::Lane lane) noexcept {
  if (context_.poll()) return;  // stopped meanwhile, and the call ended by that
  const tl::expected<Summary, Failure> outcome = work(lane);
  if (outcome) {
    succeed(*outcome);
  } else if (outcome.error().reason == Reason::kDeadlineExceeded) {
    fail(failure_of_cause(StopCause::kTimeUp));
  } else {
    fail(outcome.error());
  }
}

tl::expected<Summary, Failure> MeshJob::work(JobQueue::Lane lane) {
  const Seconds until_call_deadline = call_deadline_ - std::chrono::system_clock::now();
  const Clock::time_point deadline =
      seconds_from_now(std::min(max_seconds_, until_call_deadline.count()));
  context_.set_deadline(deadline);
  // A light job would wait in the arena for the turns of heavy ones, longer than it takes itself.
  if (lane == JobQueue::Lane::kMain)
    context_.set_arena(environment_.arena, static_cast<int>(threads_));
  {
    std::lock_guard lock(mutex_);
    work_deadline_ = deadline;
  }
  const double waited = Seconds(Clock::now() - admitted_).count();
  environment_.metrics.waited(waited);
  environment_.log->info("event=job_started job={} {} waited_seconds={:.3f}", id_, caller_, waited);
  if (!origin_.key.empty() && first_chunk_ == 0) recording_.emplace(environment_.cache.largest());
  auto summary = call_engine(environment_.engine, std::move(request_), *this, context_);
  if (!summary) return summary;
  if (recording_) environment_.cache.keep(origin_.key, std::move(*recording_).finish(*summary));
  environment_.metrics.refined(summary->engine_seconds);
  if (auto failure = check_first_chunk(*summary)) return tl::unexpected(*failure);
  return summary;
}

std::optional<Failure> MeshJob::check_first_chunk(const Summary& summary) const {
  if (first_chunk_ <= summary.chunks) return std::nullopt;
  return Failure{
      Reason::kChunkOutOfRange, "first_chunk",
      fmt::format("first_chunk is {}, but the mesh has {} chunks", first_chunk_, summary.chunks)};
}

void MeshJob::succeed(const Summary& summary) {
  v1::GenerateMeshResponse message;
  *message.mutable_summary() = to_wire(summary, threads_);
  message.mutable_summary()->set_cached(origin_.at_hand != nullptr);
  if (wants_quadtree_) add_quadtree(summary, *message.mutable_summary());
  if (finish(serialize(message))) tell_end(grpc::StatusCode::OK, "-");
}

void MeshJob::fail(const Failure& failure) {
  const ErrorRow& row = row_of(failure.reason);
  if (abort(to_status(failure, id_))) tell_end(row.code, row.name);
}

Failure MeshJob::failure_of_cause(StopCause cause) const {
  const bool call_is_late = std::chrono::system_clock::now() >= call_deadline_;
  switch (cause) {
    case StopCause::kClientGone:
      if (call_is_late) break;
      return {Reason::kCancelled, "", "the client cancelled the call"};
    case StopCause::kTimeUp:
      if (call_is_late) break;
      return {Reason::kDeadlineExceeded, "",
              fmt::format("the job worked for {} s, which is its limit", max_seconds_)};
    case StopCause::kReaderStalled:
      return {Reason::kReaderStalled, "",
              fmt::format("the client read nothing for {} s",
                          Seconds(environment_.stall_timeout).count())};
    case StopCause::kStopping:
      return {Reason::kStopping, "", "the server is stopping"};
  }
  return {Reason::kDeadlineExceeded, "", "the call's deadline passed"};
}

bool MeshJob::accept(Chunk&& chunk) {
  if (chunk.index < first_chunk_) return true;
  to_wire(chunk, *chunk_message_.mutable_chunk());
  grpc::ByteBuffer bytes = serialize(chunk_message_);
  const std::size_t length = bytes.Length();
  if (recording_) recording_->add(bytes, chunk.triangles.size() / 3);
  if (!send(std::move(bytes))) return false;
  sent(length, chunk.triangles.size() / 3);
  return true;
}

void MeshJob::sent(std::size_t bytes, std::size_t triangles) {
  environment_.metrics.chunk_sent(bytes, triangles);
  if (chunks_++ == 0) environment_.metrics.first_chunk(Seconds(Clock::now() - admitted_).count());
  bytes_ += bytes;
}

grpc::ByteBuffer MeshJob::progress_message(Clock::time_point now) {
  {
    std::lock_guard lock(mutex_);
    if (work_deadline_) told_.set_stage(std::max(told_.stage(), v1::STAGE_TRIANGULATE));
  }
  tell_progress(context_.progress(), Seconds(now - admitted_).count(), told_);
  v1::GenerateMeshResponse message;
  *message.mutable_progress() = told_;
  return serialize(message);
}

void MeshJob::tell_end(grpc::StatusCode code, std::string_view reason) const {
  const double seconds = Seconds(Clock::now() - admitted_).count();
  environment_.metrics.call_ended("GenerateMesh", code, seconds);
  environment_.log->info(
      "event=job_ended job={} {} method=GenerateMesh status={} reason={} cached={} "
      "triangles={} chunks={} bytes={} seconds={:.3f}",
      id_, caller_, code_name(code), reason, origin_.at_hand ? "yes" : "no",
      context_.progress().triangles, chunks_.load(), bytes_.load(), seconds);
}

}  // namespace weft::server
