// SPDX-License-Identifier: Apache-2.0
#include "server/console/bridge_call.h"

#include <boost/asio/post.hpp>
#include <utility>

#include "server/net/grpc_tsan_hints.h"

namespace weft::server {

std::shared_ptr<BridgeCall> BridgeCall::start(
    BridgeStub& stub, const std::string& method, const Metadata& metadata,
    std::optional<std::chrono::system_clock::time_point> deadline, boost::asio::io_context& context,
    DrainGate::Pass pass, std::shared_ptr<Listener> listener) {
  std::shared_ptr<BridgeCall> call(new BridgeCall(context, std::move(pass), std::move(listener)));
  call->self_ = call;
  for (const auto& [key, value] : metadata) call->context_.AddMetadata(key, value);
  if (deadline) call->context_.set_deadline(*deadline);
  stub.PrepareBidiStreamingCall(&call->context_, method, grpc::StubOptions(), call.get());
  call->AddHold();  // operations are started outside of gRPC's callbacks
  give_to_grpc(call.get());
  call->StartCall();
  return call;
}

void BridgeCall::write(grpc::ByteBuffer message) {
  if (!held_) return;
  outgoing_ = std::move(message);
  give_to_grpc(this);
  StartWrite(&outgoing_);
}

void BridgeCall::end_writing() {
  if (!held_) return;
  give_to_grpc(this);
  StartWritesDone();
}

void BridgeCall::read() {
  if (!held_ || reading_) return;
  reading_ = true;
  give_to_grpc(this);
  StartRead(&incoming_);
}

void BridgeCall::drop() {
  listener_.reset();
  context_.TryCancel();
  if (!reading_) release();
}

// From here on no operation is started, so gRPC may report the end.
void BridgeCall::release() {
  if (std::exchange(held_, false)) RemoveHold();
}

// The callbacks may run on any thread, even within one of the functions above.
void BridgeCall::OnReadDone(bool ok) {
  take_from_grpc(this);
  boost::asio::post(io_, [self = shared_from_this(), ok] {
    self->reading_ = false;
    if (!ok || self->listener_ == nullptr) return self->release();
    const auto listener = self->listener_;
    listener->received(std::exchange(self->incoming_, {}));
  });
}

void BridgeCall::OnWriteDone(bool ok) {
  take_from_grpc(this);
  boost::asio::post(io_, [self = shared_from_this(), ok] {
    if (const auto listener = self->listener_) listener->wrote(ok);
  });
}

void BridgeCall::OnDone(const grpc::Status& status) {
  take_from_grpc(this);
  const DrainGate::Pass pass = std::move(pass_);  // leaves the gate when all below is done
  boost::asio::post(io_, [self = std::move(self_), status] {
    const auto listener = std::exchange(self->listener_, nullptr);
    if (listener == nullptr) return;
    Metadata trailers;
    for (const auto& [key, value] : self->context_.GetServerTrailingMetadata())
      trailers.emplace_back(std::string(key.data(), key.size()),
                            std::string(value.data(), value.size()));
    listener->ended(status, trailers);
  });
}

}  // namespace weft::server
