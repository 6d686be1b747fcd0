// SPDX-License-Identifier: Apache-2.0
#include "server/admission/admission.h"

#include <fmt/format.h>
#include <grpcpp/impl/codegen/server_callback_handlers.h>
#include <grpcpp/impl/rpc_service_method.h>
#include <grpcpp/support/server_callback.h>

#include <algorithm>
#include <exception>
#include <new>
#include <utility>
#include <vector>

#include "server/net/grpc_tsan_hints.h"

namespace weft::server {
namespace {

using Clock = std::chrono::steady_clock;

// How often late messages are dropped, and suppressed lines are counted in the log.
constexpr std::chrono::milliseconds kTick{250};
// Messages up to this size are parsed without a reservation.
constexpr std::size_t kMaxUnreserved = kSmallRequest;
// What a message takes with what is parsed from it, in message sizes: numbers of one byte become
// four.
constexpr std::uint64_t kTimesTheBytes = 5;

double seconds_of(Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

Admission::Admission(const AdmissionOptions& options, const Authenticator& authenticator,
                     Metrics& metrics, Logger log)
    : options_(options),
      authenticator_(authenticator),
      metrics_(metrics),
      log_(std::move(log)),
      refusals_(log_, "call_refused", options.refusal_lines),
      requests_memory_({.capacity = options.request_bytes}, [] {}),
      ticker_([this] { tick_until_stopped(); }) {}

Admission::~Admission() {
  take_from_grpc(this);  // gRPC's Shutdown has waited for every call's end
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  stopped_.notify_all();
  ticker_.join();
}

RawCall* Admission::open(grpc::CallbackServerContext* context, const Method& method,
                         DrainGate* gate) {
  const auto raw = RawCall::make(context, *this);
  if (options_.connections != nullptr) options_.connections->call_began(raw->peer());
  try {
    admit(raw, method, gate);
  } catch (const std::bad_alloc&) {
    raw->finish({grpc::RESOURCE_EXHAUSTED, "out of memory"});
  }
  return raw->given_to_grpc();
}

void Admission::admit(const std::shared_ptr<RawCall>& raw, const Method& method, DrainGate* gate) {
  const auto call = std::make_shared<AdmittedCall>(
      AdmittedCall{raw, method.name, authenticator_.unverified(*raw->context()), std::nullopt});
  auto caller = authenticator_.identify(*raw->context());
  if (!caller && method.allow_unauthenticated) return received(call, method, grpc::ByteBuffer());
  if (!caller) return refuse(*call, caller.error());
  call->caller = std::move(*caller);
  if (gate != nullptr) {
    auto pass = gate->enter();
    if (!pass) return refuse(*call, {Reason::kStopping, "", "the server is stopping"});
    call->pass.emplace(std::move(*pass));
  }
  std::list<Reading>::iterator reading;
  {
    std::lock_guard lock(mutex_);
    reading = reading_.insert(reading_.end(), {call, Clock::now() + options_.request_timeout});
  }
  const auto leave_reading = [this, reading] {
    std::lock_guard lock(mutex_);
    reading_.erase(reading);
  };
  RawCall::OnRequest on_request;
  try {
    on_request = [=, this, &method](RawCall&, std::optional<grpc::ByteBuffer> bytes) {
      leave_reading();
      received(call, method, std::move(bytes));
    };
  } catch (...) {
    leave_reading();
    throw;
  }
  raw->read(std::move(on_request));
}

void Admission::received(const std::shared_ptr<AdmittedCall>& call, const Method& method,
                         std::optional<grpc::ByteBuffer> bytes) {
  if (!bytes) return refuse(*call, {Reason::kMalformedRequest, "", "the call carries no message"});
  if (!authenticator_.still_knows(call->caller)) return refuse(*call, token_revoked());
  if (bytes->Length() > method.most_bytes)
    return refuse(*call, {Reason::kLimitExceeded, "",
                          fmt::format("the request has {} bytes; the limit of {} is {}",
                                      bytes->Length(), method.name, method.most_bytes)});
  try {
    handle(call, method, std::move(*bytes));
  } catch (const std::bad_alloc&) {
    refuse(*call, {Reason::kOutOfMemory, "", "no memory is left for the request"});
  } catch (const std::exception& error) {
    refuse(*call, {Reason::kInternal, "", error.what()});
  }
}

void Admission::handle(const std::shared_ptr<AdmittedCall>& call, const Method& method,
                       grpc::ByteBuffer bytes) {
  if (const std::size_t length = bytes.Length(); length > kMaxUnreserved)
    if (auto failure = take(*call, length * kTimesTheBytes)) return refuse(*call, *failure);
  call->bytes = std::move(bytes);
  method.handler(call);
}

std::optional<Failure> Admission::reserve(AdmittedCall& call, std::uint64_t bytes,
                                          const char* field) {
  if (options_.memory != nullptr)
    if (const auto error = options_.memory->check_fits(0, bytes))
      return Failure{Reason::kLimitExceeded, field,
                     fmt::format("the request takes {} bytes; this server's limit for requests "
                                 "and runs is {}",
                                 bytes, options_.memory->capacity())};
  return take(call, bytes);
}

std::optional<Failure> Admission::take(AdmittedCall& call, std::uint64_t bytes) {
  RequestMemory& memory = call.memory;
  if (bytes <= kMaxUnreserved || (memory.of_requests && memory.of_requests.bytes() >= bytes)) {
    memory.shrink_to(bytes);
    return std::nullopt;
  }
  memory = {};
  const MemoryBudget::Request request{.estimate = bytes, .purpose = MemoryBudget::Purpose::kInput};
  auto of_requests = requests_memory_.reserve(request);
  if (!of_requests)
    return Failure{Reason::kOutOfMemory, "",
                   "other large requests take the memory that there is for them"};
  memory.of_requests = std::move(*of_requests);
  if (options_.memory == nullptr) return std::nullopt;
  auto of_all = options_.memory->reserve(request);
  if (!of_all)
    return Failure{Reason::kOutOfMemory, "",
                   "runs take the memory that there is for them and for requests"};
  memory.of_all = std::move(*of_all);
  return std::nullopt;
}

void Admission::refuse(const AdmittedCall& call, const Failure& failure) {
  try {
    note(call, failure);
    call.call->finish(to_status(failure, ""));
  } catch (const std::bad_alloc&) {
    call.call->finish({grpc::RESOURCE_EXHAUSTED, "out of memory"});  // so short that it needs none
  }
}

void Admission::answer(const AdmittedCall& call, grpc::ByteBuffer message) {
  metrics_.call_ended(call.method, grpc::OK, call.caller.seconds_since());
  call.call->answer(std::move(message));
}

void Admission::note(const AdmittedCall& call, const Failure& failure) {
  const grpc::StatusCode code = code_of(failure.reason);
  metrics_.call_ended(call.method, code, call.caller.seconds_since());
  if (!refusals_.allow()) return;
  log_->info("event=call_refused {} method={} status={} reason={} field={}",
             log_fields(call.caller), call.method, code_name(code), row_of(failure.reason).name,
             log_value(failure.field.empty() ? "-" : failure.field));
}

void Admission::ended(RawCall&) {
  give_to_grpc(this);
}

void Admission::expire_pending(Clock::time_point now) {
  std::vector<std::pair<std::shared_ptr<AdmittedCall>, std::list<Reading>::iterator>> late;
  {
    std::lock_guard lock(mutex_);
    for (auto each = reading_.begin(); each != reading_.end() && each->until <= now; ++each)
      late.emplace_back(each->call, each);
  }
  const Failure failure{
      Reason::kDeadlineExceeded, "",
      fmt::format("the request did not arrive within {} s", seconds_of(options_.request_timeout))};
  for (const auto& [call, reading] : late) {
    if (!call->call->give_up_reading(to_status(failure, ""))) continue;  // the message came first
    note(*call, failure);
    std::lock_guard lock(mutex_);
    reading_.erase(reading);
  }
}

void Admission::tick_until_stopped() {
  std::unique_lock lock(mutex_);
  const auto tick =
      std::clamp<Clock::duration>(options_.request_timeout, std::chrono::milliseconds(1), kTick);
  while (!stopped_.wait_for(lock, tick, [this] { return stopping_; })) {
    lock.unlock();
    try {
      expire_pending(Clock::now());
      refusals_.flush_suppressed();
    } catch (const std::bad_alloc&) {
      // The next tick does it.
    }
    lock.lock();
  }
}

void RawService::add(Admission::Method method, bool gated) {
  Entry& entry = methods_.emplace_back(Entry{name_ + method.name, std::move(method)});
  const int index = static_cast<int>(methods_.size()) - 1;
  using grpc::internal::RpcMethod;
  AddMethod(
      new grpc::internal::RpcServiceMethod(entry.path.c_str(), RpcMethod::BIDI_STREAMING, nullptr));
  DrainGate* const gate = gated ? &gate_ : nullptr;
  MarkMethodRawCallback(index,
                        new grpc::internal::CallbackBidiHandler<grpc::ByteBuffer, grpc::ByteBuffer>(
                            [this, &entry, gate](grpc::CallbackServerContext* context) {
                              return admission_.open(context, entry.method, gate);
                            }));
}

}  // namespace weft::server
