// SPDX-License-Identifier: Apache-2.0
#include "server/net/raw_call.h"

#include <utility>

#include "server/net/grpc_tsan_hints.h"

namespace weft::server {

std::shared_ptr<RawCall> RawCall::make(grpc::CallbackServerContext* context, Observer& observer) {
  std::shared_ptr<RawCall> call(new RawCall(context, observer));
  call->self_ = call;
  return call;
}

RawCall* RawCall::given_to_grpc() {
  give_to_grpc(this);
  return this;
}

void RawCall::read(OnRequest on_request) {
  on_request_ = std::move(on_request);
  {
    std::lock_guard lock(mutex_);
    reading_ = true;
  }
  give_to_grpc(this);
  StartRead(&incoming_);
}

bool RawCall::leave_reading() {
  std::lock_guard lock(mutex_);
  return std::exchange(reading_, false);
}

bool RawCall::give_up_reading(grpc::Status status) {
  if (!leave_reading()) return false;
  finish(std::move(status));
  return true;
}

void RawCall::OnReadDone(bool ok) {
  take_from_grpc(this);
  const OnRequest on_request = std::move(on_request_);
  grpc::ByteBuffer message = std::exchange(incoming_, {});  // the handler may read another
  if (leave_reading()) {
    try {
      on_request(*this, ok ? std::optional(std::move(message)) : std::nullopt);
    } catch (...) {
      finish({grpc::RESOURCE_EXHAUSTED, "out of memory"});  // short enough to need none
    }
  }
  give_to_grpc(this);
}

// gRPC is called without the lock: it may call back on this thread.
void RawCall::finish(grpc::Status status) {
  {
    std::lock_guard lock(mutex_);
    if (std::exchange(finished_, true)) return;
  }
  give_to_grpc(this);
  Finish(std::move(status));
}

void RawCall::answer(grpc::ByteBuffer message) {
  {
    std::lock_guard lock(mutex_);
    if (std::exchange(finished_, true)) return;
  }
  outgoing_ = std::move(message);
  give_to_grpc(this);
  StartWriteAndFinish(&outgoing_, grpc::WriteOptions(), grpc::Status::OK);
}

void RawCall::attach(Writer& writer) {
  bool cancelled = false;
  {
    std::lock_guard lock(mutex_);
    writer_ = &writer;
    cancelled = cancelled_;
  }
  if (cancelled) writer.cancelled();
}

void RawCall::write(grpc::ByteBuffer message) {
  outgoing_ = std::move(message);
  give_to_grpc(this);
  StartWrite(&outgoing_);
}

void RawCall::OnWriteDone(bool ok) {
  take_from_grpc(this);
  Writer* writer = nullptr;
  {
    std::lock_guard lock(mutex_);
    writer = writer_;
  }
  if (writer != nullptr) writer->written(ok);
  give_to_grpc(this);  // which counts this callback: the call is here to its end
}

void RawCall::OnCancel() {
  take_from_grpc(this);
  Writer* writer = nullptr;
  {
    std::lock_guard lock(mutex_);
    cancelled_ = true;
    writer = writer_;
  }
  if (writer != nullptr) writer->cancelled();
  give_to_grpc(this);
}

void RawCall::OnDone() {
  take_from_grpc(this);
  const auto last = std::move(self_);
  observer_.ended(*this);
  if (writer_ != nullptr) writer_->done();
}

}  // namespace weft::server
