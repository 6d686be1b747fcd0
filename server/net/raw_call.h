// SPDX-License-Identifier: Apache-2.0
// One call of any method, as bytes: messages come in when they are asked for, any number go out. It
// is there once the headers of the call are, before any byte of a message is taken; so whoever made
// it knows who calls, and may refuse him, while all that he has sent lies within HTTP/2's window of
// 64 KiB.
//
//   const auto call = RawCall::make(context, observer);
//   call->read([](RawCall& call, std::optional<grpc::ByteBuffer> request) { ... });
//   return call->given_to_grpc();
//
// A call is finished once: by `answer`, by `finish`, or by whoever took it over with `attach`.
// Ownership: a call keeps itself alive until gRPC lets go of it; others hold it by shared pointers,
// and what they call after the end has no effect.
// Thread-safety: every function may be called from any thread; `read`, `attach`, `answer` and
// `write` by one thread at a time.
#pragma once

#include <grpcpp/server_context.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace weft::server {

class RawCall final : public grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>,
                      public std::enable_shared_from_this<RawCall> {
 public:
  // Whoever writes to a call that he took over. All are called on threads of gRPC, and must not
  // wait.
  class Writer {
   public:
    // The message of `write` is gone, or, if not `ok`, the client is.
    virtual void written(bool ok) = 0;
    // The client cancelled, went away, or its deadline passed.
    virtual void cancelled() = 0;
    // Nothing more is called, and the call is over.
    virtual void done() = 0;

   protected:
    ~Writer() = default;
  };
  // Is told of every call that it is given to, whoever answers it; outlives them all.
  class Observer {
   public:
    // The client cancelled, went away, or its deadline passed.
    virtual void cancelled(RawCall& call) = 0;
    // gRPC lets go of the call.
    virtual void ended(RawCall& call) = 0;

   protected:
    ~Observer() = default;
  };
  // Nothing if the client sends no further message, or is gone.
  using OnRequest = std::function<void(RawCall&, std::optional<grpc::ByteBuffer>)>;

  static std::shared_ptr<RawCall> make(grpc::CallbackServerContext* context, Observer& observer);

  // What a handler returns: gRPC's from there on.
  RawCall* given_to_grpc();

  // Takes a message in; the handler may ask for another. What it throws ends the call with
  // RESOURCE_EXHAUSTED: a handler throws if there is no memory even for saying so.
  void read(OnRequest on_request);

  // Ends a call whose message has not come. False if it came, or the call is over.
  bool give_up_reading(grpc::Status status);

  // One message, and OK.
  void answer(grpc::ByteBuffer message);
  void finish(grpc::Status status);

  // From here on the writer is told; it outlives the call's end.
  void attach(Writer& writer);
  // REQUIRES: attached, and no write is outstanding.
  void write(grpc::ByteBuffer message);

  grpc::CallbackServerContext* context() const { return context_; }
  // The client's address, as gRPC spells it.
  const std::string& peer() const { return peer_; }

 private:
  RawCall(grpc::CallbackServerContext* context, Observer& observer)
      : context_(context), peer_(context->peer()), observer_(observer) {}

  void OnReadDone(bool ok) override;
  void OnWriteDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override;
  bool leave_reading();  // true once

  grpc::CallbackServerContext* const context_;
  const std::string peer_;
  Observer& observer_;
  OnRequest on_request_;
  grpc::ByteBuffer incoming_;
  grpc::ByteBuffer outgoing_;
  std::shared_ptr<RawCall> self_;  // until gRPC is done

  std::mutex mutex_;  // guards the four below
  Writer* writer_ = nullptr;
  bool reading_ = false;
  bool cancelled_ = false;
  bool finished_ = false;
};

}  // namespace weft::server
