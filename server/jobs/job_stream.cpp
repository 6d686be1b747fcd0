// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/job_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "server/wire/job_wire.h"
#include "server/wire/request_key.h"
#include "server/wire/translate.h"

namespace weft::server {
namespace {

using Seconds = std::chrono::duration<double>;

// Of a mesh that is fetched, two chunks wait while the third is being sent.
constexpr ChunkQueue::Bounds kReadAhead{.bytes = std::size_t{3} << 20, .count = 32};
constexpr std::size_t kChunkBytes = std::size_t{1} << 20;

// gRPC gets the bytes without a copy, and frees them.
grpc::ByteBuffer to_buffer(std::string bytes) {
  auto* kept = new std::string(std::move(bytes));
  const grpc::Slice slice(
      kept->data(), kept->size(), [](void* string) { delete static_cast<std::string*>(string); },
      kept);
  return {&slice, 1};
}

}  // namespace

JobStream::JobStream(const StreamEnvironment& environment, AdmittedCall& call, std::string id)
    : MessageStream(call.call, kReadAhead),
      environment_(environment),
      job_{call.caller, std::move(id)},
      method_(call.method),
      pass_(std::exchange(call.pass, std::nullopt)) {}

void JobStream::start() {
  soon([this] { begin(); });
}

void JobStream::tick(Clock::time_point now) {
  auto slowness = too_slow(now, environment_.patience);
  if (!slowness) return;
  fail({Reason::kReaderStalled, "", *std::move(slowness)});
  kill();
}

void JobStream::soon(std::function<void()> function) {
  const auto work = [self = shared_from_this(), function = std::move(function)](RunQueue::Slot&) {
    self->guarded(function);
  };
  if (auto refusal = environment_.threads.push({.client = job_.caller.client()}, work))
    fail(*refusal);
}

template <class F>
void JobStream::guarded(F&& function) {
  try {
    function();
  } catch (const std::exception& error) {
    fail({Reason::kInternal, "", error.what()});
  }
}

void JobStream::fail(const Failure& failure) {
  if (abort(to_status(failure, job_.id)))
    log_end(code_of(failure.reason), row_of(failure.reason).name);
}

void JobStream::log_end(grpc::StatusCode status, std::string_view reason) const {
  const double seconds = Seconds(Clock::now() - began_).count();
  environment_.metrics.call_ended(method_, status, seconds);
  if (status != grpc::OK && !environment_.may_log_failure()) return;
  environment_.log->info(
      "event=call_ended job={} {} method={} status={} reason={} bytes={} "
      "seconds={:.3f}",
      log_value(job_.id), log_fields(job_.caller), method_, code_name(status), reason,
      bytes_.load(), seconds);
}

tl::expected<JobRecord, Failure> JobStream::look_up() {
  auto job = environment_.store.get(job_.caller.name, job_.id);
  if (!job) return tl::unexpected(failure_of(job.error()));
  if (!*job) return tl::unexpected(no_such_job(job_.id));
  return std::move(**job);
}

// --- WatchStream ---

void WatchStream::begin() {
  look();
  begun_ = true;
}

void WatchStream::tick(Clock::time_point now) {
  JobStream::tick(now);
  if (begun_ && !ended()) guarded([this] { look(); });
}

void WatchStream::look() {
  const auto record = look_up();
  if (!record && record.error().reason == Reason::kStoreUnavailable && !sent_.empty())
    return;  // the store comes back, or the client's deadline passes
  if (!record) return fail(record.error());
  v1::WatchJobResponse message;
  *message.mutable_job() = to_wire(*record);
  std::string bytes = message.SerializeAsString();
  if (is_final(record->state)) {
    bytes_ += bytes.size();
    if (finish(to_buffer(std::move(bytes)))) log_end(grpc::OK, "-");
  } else if (sent_.empty()) {
    sent_ = bytes;
    send(to_buffer(std::move(bytes)));
  } else if (bytes != sent_) {
    sent_ = bytes;
    offer(to_buffer(std::move(bytes)));
  }
}

// --- FetchStream ---

void FetchStream::begin() {
  const auto record = look_up();
  if (!record) return fail(record.error());
  if (record->state != JobState::kSucceeded)
    return fail(
        {Reason::kJobNotDone, "",
         fmt::format("the job {} is {}, so it has no mesh", job_.id, state_name(record->state))});
  auto mesh = environment_.store.mesh(record->key);
  if (!mesh) return fail(failure_of(mesh.error()));
  if (!*mesh) return fail(mesh_gone(job_.id));
  mesh_ = std::move(**mesh);
  if (next_ > mesh_.chunks.size())
    return fail(
        {Reason::kChunkOutOfRange, "first_chunk",
         fmt::format("first_chunk is {}, but the mesh has {} chunks", next_, mesh_.chunks.size())});
  const auto summary = read_summary(mesh_);
  if (!summary) return fail(summary.error());
  v1::FetchMeshResponse accepted;
  accepted.mutable_accepted()->set_job_id(job_.id);
  accepted.mutable_accepted()->set_engine_version(summary->engine_version());
  accepted.mutable_accepted()->set_threads(summary->threads());
  send(serialize(accepted));
  reserve_memory();
  send_what_fits();
}

// Kept to the end of the call, however slowly the client reads.
void FetchStream::reserve_memory() {
  std::uint64_t bytes = 0;
  for (const StoredChunk& chunk : mesh_.chunks) bytes += chunk.bytes;
  auto reservation =
      environment_.memory.reserve({.estimate = std::min<std::uint64_t>(bytes, kReadAhead.bytes),
                                   .client = job_.caller.client(),
                                   .purpose = MemoryBudget::Purpose::kOutput});
  if (!reservation) return;
  MutexLock lock(mutex_);
  if (!over_) std::swap(read_ahead_, *reservation);
}

// The memory is released first: once the stream is forgotten, the server need not wait for it.
void FetchStream::ended_for_good() {
  {
    MemoryBudget::Reservation released;
    MutexLock lock(mutex_);
    over_ = true;
    std::swap(released, read_ahead_);
  }
  JobStream::ended_for_good();
}

// Without memory to read ahead, only if nothing waits.
bool FetchStream::may_read_ahead() {
  MutexLock lock(mutex_);
  const bool has_memory = static_cast<bool>(read_ahead_);
  lock.unlock();
  return has_room(has_memory ? kChunkBytes : kReadAhead.bytes);
}

// The thread that finds busy_ unset goes on, so no message is sent twice, and none is forgotten.
void FetchStream::wrote() {
  if (!busy_.exchange(true)) soon([this] { send_what_fits(); });
}

void FetchStream::send_what_fits() {
  while (may_read_ahead()) {
    if (next_ == mesh_.chunks.size()) {
      v1::FetchMeshResponse last;
      last.mutable_summary()->ParseFromString(mesh_.summary);
      if (finish(serialize(last))) log_end(grpc::OK, "-");
      return;  // and stays busy
    }
    if (!send_chunk(mesh_.chunks[next_].sha256)) return;
    ++next_;
  }
  busy_ = false;
  if (may_read_ahead()) wrote();  // a write may have ended between the two
}

bool FetchStream::send_chunk(const std::string& sha256) {
  auto chunk = environment_.store.chunk(sha256);
  if (!chunk) return fail(failure_of(chunk.error())), false;
  if (!*chunk) return fail(mesh_gone(job_.id)), false;
  if (server::sha256(**chunk) != sha256) return drop_damaged(sha256, **chunk), false;
  bytes_ += (*chunk)->size();
  environment_.metrics.chunk_sent((*chunk)->size());
  return send(to_buffer(std::move(**chunk)));
}

// The mesh is dropped, so that whoever submits the job again gets it made anew.
void FetchStream::drop_damaged(const std::string& sha256, const std::string& bytes) {
  environment_.metrics.chunk_damaged();
  const auto dropped = environment_.store.drop_damaged(sha256, bytes);
  environment_.log->error("event=chunk_damaged job={} {} bytes={} mended=no meshes_dropped={}",
                          log_value(job_.id), log_fields(job_.caller), bytes.size(),
                          dropped ? fmt::to_string(*dropped) : "-");
  if (!dropped) return fail(failure_of(dropped.error()));
  fail(mesh_damaged(job_.id));
}

}  // namespace weft::server
