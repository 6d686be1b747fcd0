// SPDX-License-Identifier: Apache-2.0
#include "server/mesh_service.h"

#include <fmt/format.h>
#include <grpcpp/impl/codegen/proto_utils.h>

#include <exception>
#include <utility>

#include "server/caller.h"
#include "server/jobs/mesh_key.h"
#include "server/refusal.h"
#include "server/translate.h"
#include "server/unary_call.h"
#include "server/wire_scan.h"

namespace weft::server {
namespace {

using Reactor = grpc::ServerWriteReactor<grpc::ByteBuffer>;

// A mesh of 100,000 triangles takes 10 ms.
constexpr std::uint64_t kLightBytes = std::uint64_t{24} << 20;
// Requests up to here are looked up in the cache: the key of a larger one costs gRPC's thread over
// a millisecond.
constexpr std::size_t kMostKeyedBytes = std::size_t{1} << 20;

}  // namespace

MeshService::MeshService(const ServiceOptions& options, const Authenticator& authenticator,
                         Metrics& metrics, EngineFn engine, Arena& arena, MemoryGate& gate,
                         Logger log)
    : options_(options),
      authenticator_(authenticator),
      metrics_(metrics),
      log_(std::move(log)),
      cache_(options.cache_bytes),
      environment_{std::move(engine),
                   arena,
                   options.limits,
                   options.stall_timeout,
                   log_,
                   queue_,
                   metrics_,
                   cache_,
                   [this](MessageStream& stream) { forget(stream); }},
      queue_({.workers = options.jobs,
              .workers_for_light = options.light_jobs,
              .capacity = options.queue,
              .light = kLightBytes,
              .gate = &gate}),
      ticker_([this] { tick_until_stopped(); }) {}

MeshService::~MeshService() {
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  ticker_.join();
}

void MeshService::stop_all() {
  for (const auto& job : open_jobs()) job->stop(StopCause::kStopping);
}

QueueFigures MeshService::figures() const {
  return {.waiting = static_cast<double>(queue_.waiting()),
          .running = static_cast<double>(queue_.running())};
}

Reactor* MeshService::GenerateMesh(grpc::CallbackServerContext* context,
                                   const grpc::ByteBuffer* request) {
  auto caller = authenticator_.identify(*context);
  if (!caller) return refuse(Authenticator::unverified(*context), caller.error());
  auto pass = gate_.enter();
  if (!pass) return refuse(*caller, {Reason::kStopping, "", "the server is stopping"});
  try {
    // gRPC made this buffer for the call and keeps it to the end: parsing frees its memory early.
    return admit(context, const_cast<grpc::ByteBuffer&>(*request), *caller, std::move(*pass));
  } catch (const std::exception& error) {
    return refuse(*caller, {Reason::kInternal, "", error.what()});
  }
}

Reactor* MeshService::admit(grpc::CallbackServerContext* context, grpc::ByteBuffer& bytes,
                            Caller caller, DrainGate::Pass pass) {
  const std::size_t size = bytes.Length();
  auto request = read(bytes);
  if (!request) return refuse(caller, request.error());
  Origin origin = origin_of(**request, size);
  std::shared_ptr<MeshJob> job;
  {
    std::lock_guard lock(mutex_);
    job = std::make_shared<MeshJob>(environment_, context, std::move(caller),
                                    fmt::format("{}-{}", options_.instance, ++last_number_),
                                    std::move(*request), std::move(pass), std::move(origin));
    jobs_.emplace(job.get(), job);
  }
  changed_.notify_all();
  job->start();
  return job->given_to_grpc();
}

tl::expected<std::unique_ptr<v1::GenerateMeshRequest>, Failure> MeshService::read(
    grpc::ByteBuffer& bytes) {
  if (auto failure = check_seed_count(count_regions(bytes), options_.limits))
    return tl::unexpected(*failure);
  auto request = std::make_unique<v1::GenerateMeshRequest>();
  const grpc::Status parsed =
      grpc::SerializationTraits<v1::GenerateMeshRequest>::Deserialize(&bytes, request.get());
  if (!parsed.ok())
    return tl::unexpected(
        Failure{Reason::kMalformedRequest, "", "the bytes are not a weft.v1.GenerateMeshRequest"});
  if (auto failure = check_shape(*request)) return tl::unexpected(*failure);
  if (auto failure = check_limits(*request, options_.limits)) return tl::unexpected(*failure);
  return request;
}

Origin MeshService::origin_of(const v1::GenerateMeshRequest& request, std::size_t bytes) {
  Origin origin;
  if (request.no_cache() || bytes > kMostKeyedBytes || cache_.largest() == 0) return origin;
  origin.key = mesh_key(request);
  origin.at_hand = cache_.find(origin.key);
  origin.at_hand ? metrics_.cache_hit() : metrics_.cache_missed();
  return origin;
}

Reactor* MeshService::refuse(const Caller& caller, const Failure& failure) {
  const ErrorRow& row = row_of(failure.reason);
  metrics_.call_ended("GenerateMesh", row.code, caller.seconds_since());
  log_->info("event=call_refused {} method=GenerateMesh status={} reason={} field={}",
             log_fields(caller), code_name(row.code), row.name,
             log_value(failure.field.empty() ? "-" : failure.field));
  return new Refusal(to_status(failure, ""));
}

grpc::ServerUnaryReactor* MeshService::GetServerInfo(grpc::CallbackServerContext* context,
                                                     const v1::GetServerInfoRequest*,
                                                     v1::GetServerInfoResponse* response) {
  auto* const call = new UnaryCall;
  const auto caller = authenticator_.identify(*context);
  const auto finish = [&](const grpc::Status& status) {
    metrics_.call_ended("GetServerInfo", status.error_code(), caller ? caller->seconds_since() : 0);
    call->finish(status);
    return call;
  };
  if (!caller) return finish(to_status(caller.error(), ""));
  if (!gate_.enter())
    return finish(to_status({Reason::kStopping, "", "the server is stopping"}, ""));
  *response = options_.info;
  return finish(grpc::Status::OK);
}

void MeshService::forget(MessageStream& stream) {
  std::shared_ptr<MeshJob> last;  // destroyed without the lock
  std::lock_guard lock(mutex_);
  const auto found = jobs_.find(&stream);
  last = std::move(found->second);
  jobs_.erase(found);
}

std::vector<std::shared_ptr<MeshJob>> MeshService::open_jobs() {
  std::vector<std::shared_ptr<MeshJob>> jobs;
  std::lock_guard lock(mutex_);
  jobs.reserve(jobs_.size());
  for (const auto& [stream, job] : jobs_) jobs.push_back(job);
  return jobs;
}

void MeshService::tick_until_stopped() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    if (jobs_.empty()) {
      changed_.wait(lock, [this] { return stopping_ || !jobs_.empty(); });
      continue;
    }
    changed_.wait_for(lock, options_.tick, [this] { return stopping_; });
    lock.unlock();
    const auto now = MessageStream::Clock::now();
    for (const auto& job : open_jobs()) job->tick(now);
    lock.lock();
  }
}

}  // namespace weft::server
