// SPDX-License-Identifier: Apache-2.0
// The sending half of a server-streaming call: any thread may queue serialized messages, which are
// sent in order, one write at a time. No gRPC thread ever waits here.
//
// Ownership: the call holds a plain pointer to the stream until `done`, so the creator must keep it
// alive until then. Other threads keep it alive by shared pointers; their calls after the end have
// no effect. Law: the call is finished exactly once, when no write is outstanding, with the status
// that the first `finish` or `abort` settled.
#pragma once

#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/status.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "server/net/chunk_queue.h"
#include "server/net/raw_call.h"
#include "server/net/reading_rate.h"

namespace weft::server {

class MessageStream : private RawCall::Writer {
 public:
  using Clock = std::chrono::steady_clock;

  virtual ~MessageStream() = default;

  MessageStream(const MessageStream&) = delete;
  MessageStream& operator=(const MessageStream&) = delete;

  // Queues a message; waits while the queue is full. Returns false once the stream has ended.
  bool send(grpc::ByteBuffer message);

  // Sends a message before all queued ones. If several are offered while a write is outstanding,
  // only the latest is sent; none is sent before the first message or after the last one.
  void offer(grpc::ByteBuffer message);

  // Sends `last` after all queued messages, then finishes the call with OK. Waits while the queue
  // is full. Returns false if an `abort` came first.
  bool finish(grpc::ByteBuffer last);

  // Drops queued messages and finishes the call as soon as no write is outstanding. Returns false
  // if the status was settled before.
  bool abort(grpc::Status status);

  // Ends the call even if a write is outstanding that the client will never read.
  void kill();

  // Takes the call over; call once, before anything is sent. If the call is cancelled already,
  // client_gone() is called at once.
  void take_call() { call_->attach(*this); }

  // Whether the status is settled: then further messages are dropped.
  bool ended() const;

  // If the client reads nothing, or too slowly while messages wait, returns a sentence that says
  // so; nullopt otherwise. Call it a few times per second, on one thread.
  std::optional<std::string> too_slow(Clock::time_point now, const ReaderPatience& patience);

 protected:
  // `bounds` limit the queue. Nothing is sent before `pump` or `send`.
  MessageStream(std::shared_ptr<RawCall> call, grpc::ByteBuffer first, ChunkQueue::Bounds bounds);
  // The first message is the first one given to `send`.
  MessageStream(std::shared_ptr<RawCall> call, ChunkQueue::Bounds bounds);

  // Starts the next write, or finishes the call, if either is due.
  void pump();

  // Whether `send` or `finish` of so many bytes would not wait.
  bool has_room(std::size_t bytes) { return queue_.has_room(bytes); }
  // The same, but waits for room for at most `patience`.
  bool has_room_within(Clock::duration patience, std::size_t bytes) {
    return queue_.has_room_within(patience, bytes);
  }

  // Called when a write has ended, so there may be room. On a thread of gRPC: must not wait.
  virtual void wrote() {}

  // Called when the client cancels, disconnects, or passes its deadline. May be called more than
  // once.
  virtual void client_gone() = 0;

  // Called last: the call will not use the stream again, so this may destroy it.
  virtual void ended_for_good() = 0;

 private:
  void written(bool ok) final;
  void cancelled() final { client_gone(); }
  void done() final;
  bool settle(grpc::Status status);  // false if it was settled before

  const std::shared_ptr<RawCall> call_;
  ChunkQueue queue_;

  mutable std::mutex mutex_;  // guards all below
  std::optional<grpc::ByteBuffer> offered_;
  bool first_sent_ = false;
  bool writing_ = false;
  bool finished_ = false;  // Finish was called
  bool last_queued_ = false;
  Clock::time_point write_started_;
  std::uint64_t writing_bytes_ = 0;  // of the outstanding write
  ReadingRate rate_;
  std::optional<grpc::Status> status_;  // to finish with, once the queue is empty

  std::mutex context_mutex_;  // guards context_, apart from the rest: cancelling calls back
  grpc::CallbackServerContext* context_;  // the call's; null after the end
};

}  // namespace weft::server
