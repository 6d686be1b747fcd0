// SPDX-License-Identifier: Apache-2.0
#include "server/message_stream.h"

#include <utility>

#include "server/grpc_handover.h"

namespace weft::server {

MessageStream::MessageStream(grpc::CallbackServerContext* context, grpc::ByteBuffer first,
                             ChunkQueue::Bounds bounds)
    : MessageStream(context, bounds) {
  queue_.push(std::move(first));
}

MessageStream::MessageStream(grpc::CallbackServerContext* context, ChunkQueue::Bounds bounds)
    : queue_(bounds), context_(context) {}

bool MessageStream::send(grpc::ByteBuffer message) {
  if (!queue_.push(std::move(message))) return false;
  pump();
  return true;
}

void MessageStream::offer(grpc::ByteBuffer message) {
  {
    std::lock_guard lock(mutex_);
    if (!first_sent_ || last_queued_ || status_) return;
    offered_ = std::move(message);
  }
  pump();
}

bool MessageStream::finish(grpc::ByteBuffer last) {
  {
    std::lock_guard lock(mutex_);
    last_queued_ = true;  // no offer may come after the last message
    offered_.reset();
  }
  if (!queue_.push(std::move(last))) return false;
  const bool first = settle(grpc::Status::OK);
  pump();
  return first;
}

// The status is settled before the queue is closed: closing wakes a thread that waits for room, and
// what that thread makes of it must come second.
bool MessageStream::abort(grpc::Status status) {
  const bool first = settle(std::move(status));
  queue_.close();
  pump();
  return first;
}

bool MessageStream::settle(grpc::Status status) {
  std::lock_guard lock(mutex_);
  if (status_) return false;
  status_ = std::move(status);
  offered_.reset();
  return true;
}

grpc::ServerWriteReactor<grpc::ByteBuffer>* MessageStream::given_to_grpc() {
  give_to_grpc(this);
  return this;
}

bool MessageStream::ended() const {
  std::lock_guard lock(mutex_);
  return status_.has_value();
}

void MessageStream::kill() {
  queue_.close();
  std::lock_guard lock(context_mutex_);
  if (context_ != nullptr) context_->TryCancel();
}

MessageStream::Clock::duration MessageStream::waiting_for_client(Clock::time_point now) const {
  std::lock_guard lock(mutex_);
  return writing_ ? now - write_started_ : Clock::duration::zero();
}

// gRPC is called without the lock: it may call back on this thread. `writing_` and `finished_` make
// the call exclusive all the same.
void MessageStream::pump() {
  std::optional<grpc::ByteBuffer> next;
  grpc::Status status;
  {
    std::lock_guard lock(mutex_);
    if (writing_ || finished_) return;
    next = offered_ ? std::exchange(offered_, std::nullopt) : queue_.try_pop();
    if (next) {
      first_sent_ = true;
      writing_ = true;
      write_started_ = Clock::now();
    } else if (status_) {
      finished_ = true;
      status = *status_;
    } else {
      return;
    }
  }
  if (next) {
    write(std::move(*next));
  } else {
    give_to_grpc(this);
    Finish(std::move(status));
  }
}

void MessageStream::write(grpc::ByteBuffer message) {
  outgoing_ = std::move(message);
  give_to_grpc(this);
  StartWrite(&outgoing_);
}

void MessageStream::OnWriteDone(bool ok) {
  take_from_grpc(this);
  {
    std::lock_guard lock(mutex_);
    writing_ = false;
  }
  if (!ok) {
    queue_.close();
    client_gone();
  }
  wrote();
  pump();
  give_to_grpc(this);  // which counts this callback: the stream is here to its end
}

void MessageStream::OnCancel() {
  take_from_grpc(this);
  client_gone();
  give_to_grpc(this);
}

void MessageStream::OnDone() {
  take_from_grpc(this);
  {
    std::lock_guard lock(context_mutex_);
    context_ = nullptr;
  }
  done();
}

}  // namespace weft::server
