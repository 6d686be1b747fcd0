// SPDX-License-Identifier: Apache-2.0
#include "server/http/call_exchange.h"

#include <grpcpp/support/proto_buffer_reader.h>

#include <optional>
#include <utility>

#include "server/wire/json.h"

namespace weft::server {
namespace {

namespace http = boost::beast::http;

}  // namespace

CallExchange::CallExchange(ExchangeParts& parts, std::vector<UnaryCall> calls, Metadata metadata,
                           std::shared_ptr<Client> answers_to, CallWords words)
    : parts_(parts),
      calls_(std::move(calls)),
      metadata_(std::move(metadata)),
      words_(std::move(words)),
      answers_to_(std::move(answers_to)) {}

void CallExchange::body_ended() {
  begin_next();
}

void CallExchange::begin_next() {
  const UnaryCall& call = calls_[next_++];
  auto pass = parts_.context.calls.enter();
  if (!pass) return;
  call_ = BridgeCall::start(parts_.context.stub, call.method, metadata_, std::nullopt,
                            parts_.context.io, std::move(*pass),
                            std::shared_ptr<BridgeCall::Listener>(shared_from_this(), this));
  call_->read();
  const grpc::Slice slice(call.request);
  call_->write({&slice, 1});
}

void CallExchange::wrote(bool) {
  if (call_ != nullptr) call_->end_writing();
}

void CallExchange::received(grpc::ByteBuffer message) {
  grpc::ProtoBufferReader reader(&message);
  calls_[next_ - 1].response->ParseFromZeroCopyStream(&reader);
  if (call_ != nullptr) call_->read();
}

void CallExchange::ended(const grpc::Status& status, const Metadata&) {
  call_.reset();
  if (status.ok() && next_ < calls_.size()) return begin_next();
  Answer answer;
  if (status.ok()) {
    const auto& message = *calls_.back().response;
    answer.head = make_page(http::status::ok, "application/json", json_of(message));
    if (words_.dress) words_.dress(answer.head, message);
  } else {
    Problem problem = problem_of(status);
    answer.head = problem_page(words_.explain ? words_.explain(std::move(problem)) : problem);
  }
  answer.head.set(http::field::cache_control, "no-store");
  if (const auto client = std::exchange(answers_to_, nullptr)) client->answer(std::move(answer));
}

void CallExchange::drop() {
  answers_to_ = nullptr;
  if (const auto call = std::exchange(call_, nullptr)) call->drop();
}

}  // namespace weft::server
