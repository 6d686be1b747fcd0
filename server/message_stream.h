// SPDX-License-Identifier: Apache-2.0
// The sending half of a server-streaming call: serialized messages go in from any thread, and go
// out one write at a time, in order. No gRPC thread ever waits here.
//
// Ownership: gRPC holds a plain pointer to the stream until `done`, so whoever creates one keeps it
// alive until then; other threads keep it alive by their own shared pointers, and whatever they
// call after the end has no effect.
// Law: the call is finished exactly once, when no write is outstanding, with the status that the
// first `finish` or `abort` settled.
#pragma once

#include <grpcpp/server_context.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include <chrono>
#include <mutex>
#include <optional>

#include "server/chunk_queue.h"

namespace weft::server {

class MessageStream : public grpc::ServerWriteReactor<grpc::ByteBuffer> {
 public:
  using Clock = std::chrono::steady_clock;

  MessageStream(const MessageStream&) = delete;
  MessageStream& operator=(const MessageStream&) = delete;

  // Puts a message in the queue and waits where that is full. False once the stream has ended.
  bool send(grpc::ByteBuffer message);

  // Sends a message before all that is queued. Of several offered while a write is outstanding the
  // latest is sent; none is before the first message or after the last one.
  void offer(grpc::ByteBuffer message);

  // Sends `last` after all that is queued, then finishes the call with OK. Waits where the queue is
  // full. False where an `abort` came first.
  bool finish(grpc::ByteBuffer last);

  // Drops what is queued and finishes the call as soon as no write is outstanding. False where the
  // status was settled before.
  bool abort(grpc::Status status);

  // Ends the call even where a write is outstanding that the client will never read.
  void kill();

  // What a handler returns: gRPC's from there on.
  grpc::ServerWriteReactor<grpc::ByteBuffer>* given_to_grpc();

  // The status is settled: whatever else is sent is lost.
  bool ended() const;

  // How long the client has taken nothing of the outstanding write.
  Clock::duration waiting_for_client(Clock::time_point now) const;

 protected:
  // At most so much is queued. Nothing is sent before `pump` or `send`.
  MessageStream(grpc::CallbackServerContext* context, grpc::ByteBuffer first,
                ChunkQueue::Bounds bounds);
  // The first message comes by `send`.
  MessageStream(grpc::CallbackServerContext* context, ChunkQueue::Bounds bounds);

  // Starts the next write, or finishes the call, if either is due.
  void pump();

  // Whether `send` or `finish` of so many bytes would not wait.
  bool has_room(std::size_t bytes) { return queue_.has_room(bytes); }

  // A write has ended, so there may be room. On a thread of gRPC: must not wait.
  virtual void wrote() {}

  // The client cancelled, went away, or its deadline passed. May be called more than once.
  virtual void client_gone() = 0;

  // gRPC will not touch the stream again: it may be destroyed from here.
  virtual void done() = 0;

 private:
  void OnWriteDone(bool ok) final;
  void OnCancel() final;
  void OnDone() final;
  bool settle(grpc::Status status);      // false where it was settled before
  void write(grpc::ByteBuffer message);  // REQUIRES: the caller has set writing_ just before

  ChunkQueue queue_;
  grpc::ByteBuffer outgoing_;  // belongs to whoever has set writing_

  mutable std::mutex mutex_;  // guards all below
  std::optional<grpc::ByteBuffer> offered_;
  bool first_sent_ = false;
  bool writing_ = false;
  bool finished_ = false;  // Finish was called
  bool last_queued_ = false;
  Clock::time_point write_started_;
  std::optional<grpc::Status> status_;  // to finish with, once the queue is empty

  std::mutex context_mutex_;  // guards context_, apart from the rest: cancelling calls back
  grpc::CallbackServerContext* context_;  // null after the end
};

}  // namespace weft::server
