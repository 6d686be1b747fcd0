// SPDX-License-Identifier: Apache-2.0
#include "server/mesh/mesh_service.h"

#include <fmt/format.h>

#include <new>
#include <utility>

#include "server/run/memory_estimate.h"
#include "server/wire/request_key.h"
#include "server/wire/request_reader.h"
#include "server/wire/translate.h"

namespace weft::server {
namespace {

// Requests up to this size are looked up in the cache: the key of a larger one would keep gRPC's
// thread busy for over a millisecond.
constexpr std::size_t kMaxKeyedBytes = std::size_t{1} << 20;

}  // namespace

MeshService::MeshService(const ServiceOptions& options, Admission& admission, Metrics& metrics,
                         EngineFn engine, ThreadPool& pool, RunQueue& queue, Logger log)
    : RawService("/weft.v1.MeshService/", admission),
      options_(options),
      metrics_(metrics),
      log_(std::move(log)),
      cache_(options.cache_bytes),
      environment_{std::move(engine),
                   pool,
                   options.limits,
                   options.patience,
                   log_,
                   queue,
                   metrics_,
                   cache_,
                   [this](MessageStream& stream) { calls_.forget(stream); },
                   [&admission] { return admission.may_log_failure(); }},
      queue_(queue),
      ticker_([this] { tick_until_stopped(); }) {
  add({"GenerateMesh", options.limits.max_request_bytes,
       [this](const auto& call) { generate_mesh(*call); }});
  add({"GetServerInfo", kSmallRequest, [this](const auto& call) { answer_server_info(*call); }});
}

MeshService::~MeshService() {
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  ticker_.join();
}

void MeshService::stop_all() {
  for (const auto& call : calls_.all()) call->stop(StopCause::kStopping);
}

QueueStats MeshService::stats() const {
  const RunQueue::Stats stats = queue_.stats();
  return {.waiting = static_cast<double>(stats.waiting),
          .running = static_cast<double>(stats.running),
          .pausing = static_cast<double>(stats.pausing)};
}

void MeshService::generate_mesh(AdmittedCall& call) {
  const std::size_t size = call.bytes.Length();
  auto request = read_mesh_request(std::exchange(call.bytes, {}), options_.limits);
  if (!request) return admission().refuse(call, request.error());
  const v1::GenerateMeshRequest& message = **request;
  // Two bytes of an empty region become 80, so what is parsed may be far more than the message.
  if (auto failure =
          admission().reserve(call, bytes_of_larger_form(message), largest_field(message)))
    return admission().refuse(call, *failure);
  auto converted = admissible(message, options_.limits);
  if (!converted) return admission().refuse(call, converted.error());
  CacheLookup cached = look_up(message, size, call.caller);
  if (cached.hit) *converted = {};
  std::shared_ptr<MeshCall> mesh_call;
  {
    std::lock_guard lock(mutex_);
    mesh_call = std::make_shared<MeshCall>(environment_, call,
                                           fmt::format("{}-{}", options_.instance, ++last_number_),
                                           message, *std::move(converted), std::move(cached));
    calls_.add(mesh_call);
  }
  changed_.notify_all();
  request->reset();
  mesh_call->take_call();
  mesh_call->start();
}

void MeshService::answer_server_info(AdmittedCall& call) {
  v1::GetServerInfoRequest request;
  if (auto failure = read_small(std::exchange(call.bytes, {}), request))
    return admission().refuse(call, *failure);
  admission().answer(call, serialize(options_.info));
}

CacheLookup MeshService::look_up(const v1::GenerateMeshRequest& request, std::size_t bytes,
                                 const Caller& caller) {
  CacheLookup found;
  if (request.no_cache() || bytes > kMaxKeyedBytes || cache_.largest() == 0) return found;
  found.key = mesh_key(request);
  if (!options_.share_across_clients) found.key = key_of_client(found.key, caller.name);
  found.hit = cache_.find(found.key);
  found.hit ? metrics_.cache_hit() : metrics_.cache_missed();
  return found;
}

void MeshService::tick_until_stopped() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    if (calls_.empty()) {
      changed_.wait(lock, [this] { return stopping_ || !calls_.empty(); });
      continue;
    }
    changed_.wait_for(lock, options_.tick, [this] { return stopping_; });
    lock.unlock();
    const auto now = MessageStream::Clock::now();
    try {
      for (const auto& call : calls_.all()) call->tick(now);
    } catch (const std::bad_alloc&) {
      // The next tick does it.
    }
    lock.lock();
  }
}

}  // namespace weft::server
