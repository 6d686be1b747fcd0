// SPDX-License-Identifier: Apache-2.0
// One call of any method, as bytes: it receives messages on request, and sends any number. It
// exists once the call's headers have arrived, before any byte of a message is read. So a caller
// can be identified and refused while all that it has sent fits in HTTP/2's window of 64 KiB.
//
//   const auto call = RawCall::make(context, observer);
//   call->read([](RawCall& call, std::optional<grpc::ByteBuffer> request) { ... });
//   return call->given_to_grpc();
//
// A call is finished once: by `answer`, by `finish`, or by the writer that took it over with
// `attach`. Ownership: a call keeps itself alive until gRPC releases it; others hold it by shared
// pointers, and their calls after the end have no effect.
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
  // Writes to a call that it took over. Its functions are called on threads of gRPC, and must not
  // wait.
  class Writer {
   public:
    // The message of `write` was sent; if not `ok`, the client is gone.
    virtual void written(bool ok) = 0;
    // The client cancelled, went away, or its deadline passed.
    virtual void cancelled() = 0;
    // The call is over, and no function is called after this one.
    virtual void done() = 0;

   protected:
    ~Writer() = default;
  };
  // Is notified of the end of every call that it is given to; must outlive them all.
  class Observer {
   public:
    // gRPC releases the call.
    virtual void ended(RawCall& call) = 0;

   protected:
    ~Observer() = default;
  };
  // The argument is nullopt if the client sends no further message, or is gone.
  using OnRequest = std::function<void(RawCall&, std::optional<grpc::ByteBuffer>)>;

  static std::shared_ptr<RawCall> make(grpc::CallbackServerContext* context, Observer& observer);

  // For a handler to return: from there on, gRPC owns the call.
  RawCall* given_to_grpc();

  // Receives a message; the handler may request another. If the handler throws, the call ends with
  // RESOURCE_EXHAUSTED: handlers throw if there is not even memory for a reply.
  void read(OnRequest on_request);

  // Ends a call whose message has not arrived. Returns false if it has, or if the call is over.
  bool give_up_reading(grpc::Status status);

  // Sends one message, and finishes with OK.
  void answer(grpc::ByteBuffer message);
  void finish(grpc::Status status);

  // From here on the writer is notified; it must outlive the call's end.
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
