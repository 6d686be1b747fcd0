// SPDX-License-Identifier: Apache-2.0
#include "server/net/message_stream.h"

#include <fmt/format.h>

#include <utility>

namespace weft::server {

MessageStream::MessageStream(std::shared_ptr<RawCall> call, grpc::ByteBuffer first,
                             ChunkQueue::Bounds bounds)
    : MessageStream(std::move(call), bounds) {
  queue_.push(std::move(first));
}

MessageStream::MessageStream(std::shared_ptr<RawCall> call, ChunkQueue::Bounds bounds)
    : call_(std::move(call)), queue_(bounds), context_(call_->context()) {}

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

// The status is set before the queue is closed: closing wakes a thread that waits for room, and
// that thread's status must come second.
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

bool MessageStream::ended() const {
  std::lock_guard lock(mutex_);
  return status_.has_value();
}

void MessageStream::kill() {
  queue_.close();
  std::lock_guard lock(context_mutex_);
  if (context_ != nullptr) context_->TryCancel();
}

std::optional<std::string> MessageStream::too_slow(Clock::time_point now,
                                                   const ReaderPatience& patience) {
  std::lock_guard lock(mutex_);
  if (!writing_) return std::nullopt;
  const double seconds = std::chrono::duration<double>(patience.stall_timeout).count();
  if (now - write_started_ >= patience.stall_timeout)
    return fmt::format("the client read nothing for {} s", seconds);
  return rate_.too_slow(now, patience);
}

// The call is used without the lock: it may call back on this thread. `writing_` and `finished_`
// make the call exclusive all the same.
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
      writing_bytes_ = next->Length();
      rate_.start(write_started_);
    } else if (status_) {
      finished_ = true;
      status = *status_;
    } else {
      rate_.rest();
      return;
    }
  }
  if (next) {
    call_->write(std::move(*next));
  } else {
    call_->finish(std::move(status));
  }
}

void MessageStream::written(bool ok) {
  {
    std::lock_guard lock(mutex_);
    writing_ = false;
    rate_.add(writing_bytes_);
  }
  if (!ok) {
    queue_.close();
    client_gone();
  }
  wrote();
  pump();
}

void MessageStream::done() {
  {
    std::lock_guard lock(context_mutex_);
    context_ = nullptr;
  }
  ended_for_good();
}

}  // namespace weft::server
