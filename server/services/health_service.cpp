// SPDX-License-Identifier: Apache-2.0
#include "server/services/health_service.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/wire_format_lite.h>
#include <grpcpp/support/proto_buffer_reader.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace weft::server {
namespace {

using google::protobuf::internal::WireFormatLite;

constexpr std::size_t kMaxBytes = 1024;
// Each watch holds a stream, for a caller that nobody knows.
constexpr std::size_t kMaxWatches = 1024;
constexpr std::ptrdiff_t kMaxWatchesOfClient = 64;
// HealthCheckRequest.service, and HealthCheckResponse.status with its values.
constexpr std::uint32_t kServiceTag =
    WireFormatLite::MakeTag(1, WireFormatLite::WIRETYPE_LENGTH_DELIMITED);
constexpr char kStatusTag = 0x08;
constexpr char kStatusServing = 1;
constexpr char kStatusNotServing = 2;
constexpr char kStatusServiceUnknown = 3;

// The service that is asked for; nullopt if the bytes are malformed.
std::optional<std::string> service_in(grpc::ByteBuffer bytes) {
  if (bytes.Length() == 0) return "";
  grpc::ProtoBufferReader reader(&bytes);
  google::protobuf::io::CodedInputStream in(&reader);
  std::string service;
  while (const std::uint32_t tag = in.ReadTag()) {
    const bool read = tag == kServiceTag ? WireFormatLite::ReadBytes(&in, &service)
                                         : WireFormatLite::SkipField(&in, tag);
    if (!read) return std::nullopt;
  }
  if (!in.ConsumedEntireMessage()) return std::nullopt;
  return service;
}

grpc::ByteBuffer response(char status) {
  const char bytes[] = {kStatusTag, status};
  const grpc::Slice slice(bytes, sizeof bytes);
  return {&slice, 1};
}

char status_of(const std::map<std::string, bool>& serving, const std::string& service) {
  const auto found = serving.find(service);
  if (found == serving.end()) return kStatusServiceUnknown;
  return found->second ? kStatusServing : kStatusNotServing;
}

}  // namespace

class HealthService::Watch final : public MessageStream {
 public:
  Watch(HealthService& owner, const AdmittedCall& call, std::string service, char status)
      : MessageStream(call.call, response(status), {}),
        owner_(owner),
        caller_(call.caller),
        service_(std::move(service)) {}

  void start() { pump(); }
  void tell(char status) { offer(response(status)); }
  const std::string& service() const { return service_; }
  const Caller& caller() const { return caller_; }
  void revoke() { abort(to_status(token_revoked(), "")); }

 private:
  void client_gone() override { abort({grpc::CANCELLED, "the client cancelled the call"}); }
  void ended_for_good() override { owner_.watches_.forget(*this); }

  HealthService& owner_;
  const Caller caller_;
  const std::string service_;
};

HealthService::HealthService(Admission& admission)
    : RawService("/grpc.health.v1.Health/", admission) {
  const auto asked = [this](auto handler) {
    return [this, handler](const std::shared_ptr<AdmittedCall>& call) {
      const auto service = service_in(std::exchange(call->bytes, {}));
      if (service) return (this->*handler)(*call, *service);
      this->admission().refuse(*call, {Reason::kMalformedRequest, "",
                                       "the bytes are not a grpc.health.v1.HealthCheckRequest"});
    };
  };
  constexpr bool kUngated = false;  // a server that drains is asked, too
  add({"Check", kMaxBytes, asked(&HealthService::check), true}, kUngated);
  add({"Watch", kMaxBytes, asked(&HealthService::watch), true}, kUngated);
}

HealthService::~HealthService() = default;

void HealthService::set(const std::string& service, bool serving) {
  std::vector<std::shared_ptr<Watch>> told;
  {
    std::lock_guard lock(mutex_);
    serving_[service] = serving;
    for (const auto& watch : watches_.all())
      if (watch->service() == service) told.push_back(watch);
  }
  for (const auto& watch : told) watch->tell(serving ? kStatusServing : kStatusNotServing);
}

void HealthService::set_all(bool serving) {
  std::vector<std::string> services;
  {
    std::lock_guard lock(mutex_);
    for (const auto& [service, was] : serving_) services.push_back(service);
  }
  for (const std::string& service : services) set(service, serving);
}

void HealthService::revoke_unknown(const Authenticator& authenticator) {
  watches_.revoke_unknown(authenticator);
}

void HealthService::check(const AdmittedCall& call, const std::string& service) {
  char status = 0;
  {
    std::lock_guard lock(mutex_);
    status = status_of(serving_, service);
  }
  if (status == kStatusServiceUnknown)
    return call.call->finish({grpc::NOT_FOUND, "unknown service"});
  call.call->answer(response(status));
}

void HealthService::watch(const AdmittedCall& call, const std::string& service) {
  std::shared_ptr<Watch> watch;
  char first = 0;
  {
    std::lock_guard lock(mutex_);
    if (watches_.size() >= kMaxWatches)
      return call.call->finish({grpc::RESOURCE_EXHAUSTED, "too many watch already"});
    const auto all = watches_.all();
    const auto is_of_client = [client = call.caller.client()](const auto& other) {
      return other->caller().client() == client;
    };
    if (std::ranges::count_if(all, is_of_client) >= kMaxWatchesOfClient)
      return call.call->finish({grpc::RESOURCE_EXHAUSTED, "you watch too often already"});
    first = status_of(serving_, service);
    watch = std::make_shared<Watch>(*this, call, service, first);
    watches_.add(watch);
  }
  watch->take_call();
  watch->start();
  std::unique_lock lock(mutex_);
  const char now = status_of(serving_, service);
  lock.unlock();
  if (now != first) watch->tell(now);  // a change before the first message was sent would be lost
}

}  // namespace weft::server
