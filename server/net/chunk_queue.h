// SPDX-License-Identifier: Apache-2.0
// The queue between an engine that makes messages and a stream that sends them: first in,
// first out, bounded by bytes and by count. The engine's thread waits if the queue is full; the
// stream's thread never waits.
//
// Thread-safety: every function may be called from any thread.
// Law: one message is always admitted to an empty queue, however large.
#pragma once

#include <grpcpp/support/byte_buffer.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>

namespace weft::server {

class ChunkQueue {
 public:
  struct Bounds {
    std::size_t bytes = std::size_t{8} << 20;
    std::size_t count = 32;

    // Chunks have 100 to 400 KB.
    static Bounds of_bytes(std::size_t bytes) {
      return {bytes, std::max<std::size_t>(32, bytes >> 18)};
    }
  };

  explicit ChunkQueue(Bounds bounds) : bounds_(bounds) {}

  // Waits while the queue is full. Returns false, and drops the message, if the queue is closed or
  // closes while waiting.
  bool push(grpc::ByteBuffer message);

  // Whether a message of so many bytes would not wait.
  bool has_room(std::size_t bytes);

  // The same, but waits for room for at most `patience`.
  bool has_room_within(std::chrono::steady_clock::duration patience, std::size_t bytes);

  // Returns nullopt if the queue is empty.
  std::optional<grpc::ByteBuffer> try_pop();

  // Drops queued messages, wakes waiting threads and refuses new messages.
  void close();

 private:
  bool full_for(std::size_t bytes) const {
    return !messages_.empty() &&
           (messages_.size() >= bounds_.count || bytes_ + bytes > bounds_.bytes);
  }

  const Bounds bounds_;
  std::mutex mutex_;  // guards all below
  std::condition_variable room_;
  std::deque<grpc::ByteBuffer> messages_;
  std::size_t bytes_ = 0;
  bool closed_ = false;
};

}  // namespace weft::server
