// SPDX-License-Identifier: Apache-2.0
// A call with one answer, which may be given on any thread.
#pragma once

#include <grpcpp/support/server_callback.h>

#include <utility>

#include "server/grpc_handover.h"

namespace weft::server {

// Owns itself: `new UnaryCall` is what the handler returns, and gRPC lets go of it after `finish`.
class UnaryCall final : public grpc::ServerUnaryReactor {
 public:
  // The response is complete. Call once; the call may be gone after it.
  void finish(grpc::Status status) {
    give_to_grpc(this);
    Finish(std::move(status));
  }

 private:
  void OnDone() override {
    take_from_grpc(this);
    delete this;
  }
};

}  // namespace weft::server
