// SPDX-License-Identifier: Apache-2.0
#include "server/services/reflection_service.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>
#include <grpcpp/alarm.h>

#include <chrono>
#include <optional>
#include <set>
#include <utility>

#include "grpc/health/v1/health.pb.h"
#include "grpc/reflection/v1/reflection.pb.h"
#include "server/wire/request_reader.h"
#include "server/wire/translate.h"

namespace weft::server {
namespace {

namespace wire = grpc::reflection::v1;
using google::protobuf::DescriptorPool;
using google::protobuf::FileDescriptor;

// Each conversation is a stream that its client may leave open.
constexpr std::size_t kMaxConversations = 64;
constexpr std::chrono::seconds kLongestConversation{60};

void add_with_imports(const FileDescriptor& file, std::set<const FileDescriptor*>& seen,
                      wire::FileDescriptorResponse& out) {
  if (!seen.insert(&file).second) return;
  google::protobuf::FileDescriptorProto proto;
  file.CopyTo(&proto);
  out.add_file_descriptor_proto(proto.SerializeAsString());
  for (int i = 0; i < file.dependency_count(); ++i)
    add_with_imports(*file.dependency(i), seen, out);
}

// Null if there is none.
const FileDescriptor* file_asked_for(const wire::ServerReflectionRequest& request) {
  const DescriptorPool& pool = *DescriptorPool::generated_pool();
  switch (request.message_request_case()) {
    case wire::ServerReflectionRequest::kFileByFilename:
      return pool.FindFileByName(request.file_by_filename());
    case wire::ServerReflectionRequest::kFileContainingSymbol:
      return pool.FindFileContainingSymbol(request.file_containing_symbol());
    default:
      return nullptr;  // no message of weft has extensions
  }
}

wire::ServerReflectionResponse answer_to(const wire::ServerReflectionRequest& request,
                                         const std::vector<std::string>& services) {
  wire::ServerReflectionResponse response;
  response.set_valid_host(request.host());
  *response.mutable_original_request() = request;
  if (request.message_request_case() == wire::ServerReflectionRequest::kListServices) {
    for (const std::string& name : services)
      response.mutable_list_services_response()->add_service()->set_name(name);
  } else if (const FileDescriptor* file = file_asked_for(request)) {
    std::set<const FileDescriptor*> seen;
    add_with_imports(*file, seen, *response.mutable_file_descriptor_response());
  } else {
    response.mutable_error_response()->set_error_code(grpc::StatusCode::NOT_FOUND);
    response.mutable_error_response()->set_error_message("this server has no such file or symbol");
  }
  return response;
}

}  // namespace

// Reads a request, writes its answer, and so on. A read or a write is pending until the call is
// finished, so every failure shows there.
class ReflectionService::Conversation final : public RawCall::Writer,
                                              public std::enable_shared_from_this<Conversation> {
 public:
  Conversation(ReflectionService& owner, const AdmittedCall& call)
      : owner_(owner), call_(call.call), context_(call.call->context()) {}

  void start(grpc::ByteBuffer first) {
    call_->attach(*this);
    alarm_.Set(std::chrono::system_clock::now() + kLongestConversation,
               [weak = weak_from_this()](bool due) {  // an alarm keeps its function until it ends
                 const auto self = due ? weak.lock() : nullptr;
                 if (self) self->cut_off();
               });
    answer(std::move(first));
  }

 private:
  void answer(grpc::ByteBuffer bytes) {
    wire::ServerReflectionRequest request;
    if (const auto failure = read_small(std::move(bytes), request))
      return call_->finish(to_status(*failure, ""));
    call_->write(serialize(answer_to(request, owner_.services_)));
  }
  void written(bool ok) override {
    if (!ok) return call_->finish({grpc::CANCELLED, "the client went away"});
    call_->read([this](RawCall&, std::optional<grpc::ByteBuffer> bytes) {
      if (!bytes) return call_->finish(grpc::Status::OK);
      if (bytes->Length() > kSmallRequest)
        return call_->finish({grpc::INVALID_ARGUMENT, "the request is too large"});
      answer(std::move(*bytes));
    });
  }
  void cancelled() override {}
  void done() override {
    alarm_.Cancel();
    {
      std::lock_guard lock(mutex_);
      context_ = nullptr;
    }
    owner_.forget(*this);
  }
  void cut_off() {
    std::lock_guard lock(mutex_);
    if (context_ != nullptr) context_->TryCancel();
  }

  ReflectionService& owner_;
  const std::shared_ptr<RawCall> call_;
  grpc::Alarm alarm_;
  std::mutex mutex_;                      // guards the one below
  grpc::CallbackServerContext* context_;  // null after the end
};

ReflectionService::ReflectionService(Admission& admission, std::vector<std::string> services)
    : RawService("/grpc.reflection.v1.ServerReflection/", admission),
      services_(std::move(services)) {
  // Links in the files of services that are listed, and that nothing else needs.
  grpc::health::v1::HealthCheckRequest::descriptor();
  constexpr bool kUngated = false;  // a client that explores the server does not delay a drain
  add({"ServerReflectionInfo", kSmallRequest, [this](const auto& call) { converse(*call); }},
      kUngated);
}

ReflectionService::~ReflectionService() = default;

void ReflectionService::converse(AdmittedCall& call) {
  std::shared_ptr<Conversation> conversation;
  {
    std::lock_guard lock(mutex_);
    if (open_.size() < kMaxConversations) {
      conversation = std::make_shared<Conversation>(*this, call);
      open_.emplace(conversation.get(), conversation);
    }
  }
  if (!conversation)
    return call.call->finish({grpc::RESOURCE_EXHAUSTED, "too many streams of reflection are open"});
  conversation->start(std::exchange(call.bytes, {}));
}

void ReflectionService::forget(const Conversation& conversation) {
  std::shared_ptr<Conversation> last;  // destroyed without the lock
  std::lock_guard lock(mutex_);
  const auto found = open_.find(&conversation);
  last = std::move(found->second);
  open_.erase(found);
}

}  // namespace weft::server
