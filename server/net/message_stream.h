// SPDX-License-Identifier: Apache-2.0
// The sending half of a server-streaming call: serialized messages go in from any thread, and go
// out one write at a time, in order. No gRPC thread ever waits here.
//
// Ownership: the call holds a plain pointer to the stream until `done`, so whoever creates one
// keeps it alive until then; other threads keep it alive by their own shared pointers, and whatever
// they call after the end has no effect. Law: the call is finished exactly once, when no write is
// outstanding, with the status that the first `finish` or `abort` settled.
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

namespace weft::server {

// How slowly a client may read while a message waits for it.
struct ReaderPatience {
  // It may take nothing for so long.
  std::chrono::steady_clock::duration stall_timeout = std::chrono::seconds(60);
  // Bytes a second, on average over stall_timeout. 0: any.
  std::uint64_t least_rate = 4096;
};

class MessageStream : private RawCall::Writer {
 public:
  using Clock = std::chrono::steady_clock;

  virtual ~MessageStream() = default;

  MessageStream(const MessageStream&) = delete;
  MessageStream& operator=(const MessageStream&) = delete;

  // Puts a message in the queue and waits if that is full. False once the stream has ended.
  bool send(grpc::ByteBuffer message);

  // Sends a message before all that is queued. Of several offered while a write is outstanding the
  // latest is sent; none is before the first message or after the last one.
  void offer(grpc::ByteBuffer message);

  // Sends `last` after all that is queued, then finishes the call with OK. Waits where the queue is
  // full. False if an `abort` came first.
  bool finish(grpc::ByteBuffer last);

  // Drops what is queued and finishes the call as soon as no write is outstanding. False if the
  // status was settled before.
  bool abort(grpc::Status status);

  // Ends the call even if a write is outstanding that the client will never read.
  void kill();

  // Takes the call over; call once, before anything is sent. A call that is cancelled already says
  // so at once.
  void take_call() { call_->attach(*this); }

  // The status is settled: whatever else is sent is lost.
  bool ended() const;

  // What is wrong with a client that takes nothing, or too little of what there is to take; nothing
  // if there is nothing wrong. Call a few times a second, on one thread.
  std::optional<std::string> too_slow(Clock::time_point now, const ReaderPatience& patience);

 protected:
  // At most so much is queued. Nothing is sent before `pump` or `send`.
  MessageStream(std::shared_ptr<RawCall> call, grpc::ByteBuffer first, ChunkQueue::Bounds bounds);
  // The first message comes by `send`.
  MessageStream(std::shared_ptr<RawCall> call, ChunkQueue::Bounds bounds);

  // Starts the next write, or finishes the call, if either is due.
  void pump();

  // Whether `send` or `finish` of so many bytes would not wait.
  bool has_room(std::size_t bytes) { return queue_.has_room(bytes); }
  // The same; waits for room, if there is none, at most so long.
  bool has_room_within(Clock::duration patience, std::size_t bytes) {
    return queue_.has_room_within(patience, bytes);
  }

  // A write has ended, so there may be room. On a thread of gRPC: must not wait.
  virtual void wrote() {}

  // The client cancelled, went away, or its deadline passed. May be called more than once.
  virtual void client_gone() = 0;

  // The call will not touch the stream again: it may be destroyed from here.
  virtual void ended_for_good() = 0;

 private:
  void written(bool ok) final;
  void cancelled() final { client_gone(); }
  void done() final;
  bool settle(grpc::Status status);  // false where it was settled before

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
  // Since when something has waited for the client without a break, or since it was last judged;
  // and how much it has taken since then.
  std::optional<Clock::time_point> measured_since_;
  std::uint64_t taken_bytes_ = 0;
  std::optional<grpc::Status> status_;  // to finish with, once the queue is empty

  std::mutex context_mutex_;  // guards context_, apart from the rest: cancelling calls back
  grpc::CallbackServerContext* context_;  // the call's; null after the end
};

}  // namespace weft::server
