// SPDX-License-Identifier: Apache-2.0
#include "server/net/chunk_queue.h"

#include <utility>

namespace weft::server {

bool ChunkQueue::push(grpc::ByteBuffer message) {
  const std::size_t bytes = message.Length();
  std::unique_lock lock(mutex_);
  room_.wait(lock, [&] { return closed_ || !full_for(bytes); });
  if (closed_) return false;
  bytes_ += bytes;
  messages_.push_back(std::move(message));
  return true;
}

bool ChunkQueue::has_room(std::size_t bytes) {
  std::lock_guard lock(mutex_);
  return closed_ || !full_for(bytes);
}

bool ChunkQueue::has_room_within(std::chrono::steady_clock::duration patience, std::size_t bytes) {
  std::unique_lock lock(mutex_);
  return room_.wait_for(lock, patience, [&] { return closed_ || !full_for(bytes); });
}

std::optional<grpc::ByteBuffer> ChunkQueue::try_pop() {
  std::lock_guard lock(mutex_);
  if (messages_.empty()) return std::nullopt;
  grpc::ByteBuffer message = std::move(messages_.front());
  messages_.pop_front();
  bytes_ -= message.Length();
  room_.notify_one();
  return message;
}

void ChunkQueue::close() {
  std::deque<grpc::ByteBuffer> dropped;
  std::lock_guard lock(mutex_);
  closed_ = true;
  dropped.swap(messages_);
  bytes_ = 0;
  room_.notify_all();
}

}  // namespace weft::server
