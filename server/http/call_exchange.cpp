// SPDX-License-Identifier: Apache-2.0
#include "server/http/call_exchange.h"

#include <google/protobuf/util/json_util.h>
#include <grpcpp/support/proto_buffer_reader.h>

#include <optional>
#include <utility>

#include "server/console/problem.h"

namespace weft::server {
namespace {

namespace http = boost::beast::http;

std::string json_of(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = true;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string text;
  // Fails for messages of unknown types in it alone.
  (void)google::protobuf::util::MessageToJsonString(message, &text, options);
  return text;
}

}  // namespace

CallExchange::CallExchange(ExchangeParts& parts, std::string method, std::string request,
                           std::unique_ptr<google::protobuf::Message> response, Visit& visit)
    : parts_(parts),
      method_(std::move(method)),
      request_(std::move(request)),
      response_(std::move(response)),
      metadata_(std::move(visit.metadata)),
      answers_to_(std::move(visit.answers_to)) {}

void CallExchange::body_ended() {
  auto pass = parts_.context.calls.enter();
  if (!pass) return;
  call_ = BridgeCall::start(parts_.context.stub, method_, metadata_, std::nullopt,
                            parts_.context.io, std::move(*pass),
                            std::shared_ptr<BridgeCall::Listener>(shared_from_this(), this));
  call_->read();
  const grpc::Slice slice(request_);
  call_->write({&slice, 1});
}

void CallExchange::wrote(bool) {
  if (call_ != nullptr) call_->end_writing();
}

void CallExchange::received(grpc::ByteBuffer message) {
  grpc::ProtoBufferReader reader(&message);
  response_->ParseFromZeroCopyStream(&reader);
  if (call_ != nullptr) call_->read();
}

void CallExchange::ended(const grpc::Status& status, const Metadata&) {
  call_.reset();
  Answer answer{.head = status.ok()
                            ? make_page(http::status::ok, "application/json", json_of(*response_))
                            : problem_page(problem_of(status))};
  answer.head.set(http::field::cache_control, "no-store");
  if (const auto client = std::exchange(answers_to_, nullptr)) client->answer(std::move(answer));
}

void CallExchange::drop() {
  answers_to_ = nullptr;
  if (const auto call = std::exchange(call_, nullptr)) call->drop();
}

}  // namespace weft::server
