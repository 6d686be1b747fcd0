// SPDX-License-Identifier: Apache-2.0
// One call that the console makes for a browser, within the process: of any method, as bytes. All
// that happens is reported on one thread, the one that runs the io_context.
//
//   auto call = BridgeCall::start(stub, "/weft.v1.MeshService/GenerateMesh", metadata, deadline,
//                                 context, gate.enter(), listener);
//   call->write(message);         // then `wrote`
//   call->end_writing();
//   call->read();                 // then `received`, or `ended`
//
// gRPC's transport within a process hands a message over only once it is asked for, so a call whose
// messages are not asked for makes its server wait, as a connection that nobody reads does.
// Ownership: a call keeps itself alive until gRPC releases it. Thread-safety: none; every function
// is called on the thread that runs the io_context.
#pragma once

#include <grpcpp/client_context.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/client_callback.h>

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "server/console/frames.h"
#include "server/net/drain_gate.h"

namespace weft::server {

using BridgeStub = grpc::TemplatedGenericStub<grpc::ByteBuffer, grpc::ByteBuffer>;

class BridgeCall final : private grpc::ClientBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>,
                         public std::enable_shared_from_this<BridgeCall> {
 public:
  class Listener {
   public:
    // The message of `write` has been taken; if not `ok`, the call takes no more.
    virtual void wrote(bool ok) = 0;
    virtual void received(grpc::ByteBuffer message) = 0;
    // Last. The metadata are those that came with the status.
    virtual void ended(const grpc::Status& status, const Metadata& trailers) = 0;

   protected:
    ~Listener() = default;
  };

  // The listener is kept alive until the call has ended, or is dropped. REQUIRES: keys and values
  // of the metadata are legal.
  static std::shared_ptr<BridgeCall> start(
      BridgeStub& stub, const std::string& method, const Metadata& metadata,
      std::optional<std::chrono::system_clock::time_point> deadline,
      boost::asio::io_context& context, DrainGate::Pass pass, std::shared_ptr<Listener> listener);

  // REQUIRES: no write is outstanding, and `end_writing` was not called.
  void write(grpc::ByteBuffer message);
  void end_writing();
  // REQUIRES: no message is asked for already.
  void read();

  // Cancels the call; the listener is not called any more.
  void drop();

 private:
  BridgeCall(boost::asio::io_context& context, DrainGate::Pass pass,
             std::shared_ptr<Listener> listener)
      : io_(context), pass_(std::move(pass)), listener_(std::move(listener)) {}

  void OnReadDone(bool ok) override;
  void OnWriteDone(bool ok) override;
  void OnDone(const grpc::Status& status) override;
  void release();

  boost::asio::io_context& io_;
  DrainGate::Pass pass_;
  std::shared_ptr<Listener> listener_;
  grpc::ClientContext context_;
  grpc::ByteBuffer incoming_;
  grpc::ByteBuffer outgoing_;
  bool held_ = true;  // further operations may be started
  bool reading_ = false;
  std::shared_ptr<BridgeCall> self_;  // until gRPC is done
};

}  // namespace weft::server
