// SPDX-License-Identifier: Apache-2.0
// Ends a streaming call before it began.
#pragma once

#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include <utility>

#include "server/grpc_handover.h"

namespace weft::server {

// Owns itself: `new Refusal(status)` is what the handler returns.
class Refusal final : public grpc::ServerWriteReactor<grpc::ByteBuffer> {
 public:
  explicit Refusal(grpc::Status status) {
    give_to_grpc(this);
    Finish(std::move(status));
  }
  void OnDone() override {
    take_from_grpc(this);
    delete this;
  }
};

}  // namespace weft::server
