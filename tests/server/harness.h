// SPDX-License-Identifier: Apache-2.0
// A real server on a real socket, with an engine that does what the test says.
#pragma once

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>
#include <grpcpp/create_channel.h>
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "server/server.h"
#include "tests/support/event.h"
#include "weft/v1/mesh_service.grpc.pb.h"

namespace weft::server::testing {

using Stub = v1::MeshService::Stub;
using Reader = std::unique_ptr<grpc::ClientReader<v1::GenerateMeshResponse>>;

// A mesh-like chunk of about `bytes` bytes.
Chunk make_chunk(std::uint32_t index, std::size_t bytes = 64);

// Sends `count` chunks and says so in the summary.
Result<Summary> send_chunks(ChunkSink& sink, std::uint32_t count, std::size_t bytes = 64);

// An engine that sends `count` chunks.
inline EngineFn engine_of_chunks(std::uint32_t count, std::size_t bytes = 64) {
  return [=](const auto&, ChunkSink& sink, auto&) { return send_chunks(sink, count, bytes); };
}

// Sends chunks of 1 MiB until the sink refuses one; `sent` counts them.
Result<Summary> send_until_refused(ChunkSink& sink, std::atomic<std::uint32_t>& sent);

// Works until the context says stop, and returns what it says.
Result<Summary> work_until_stopped(const weft::Run& run);

// A square with a hole, all arrays of the right shape.
v1::GenerateMeshRequest valid_request();

class TestServer {
 public:
  explicit TestServer(EngineFn engine, const ServiceOptions& options = {});

  Server& operator*() { return *server_; }
  Server* operator->() { return server_.get(); }
  const std::string& address() const { return server_->addresses().front(); }
  std::shared_ptr<grpc::Channel> channel() const;
  std::unique_ptr<Stub> stub() const { return v1::MeshService::NewStub(channel()); }

 private:
  std::unique_ptr<Server> server_;
};

// A call read to its end.
struct Outcome {
  std::vector<v1::GenerateMeshResponse> messages;
  grpc::Status status;

  std::vector<std::uint32_t> chunk_indices() const;
};
Outcome call(Stub& stub, const v1::GenerateMeshRequest& request);
Outcome read_all(grpc::ClientReader<v1::GenerateMeshResponse>& reader);

// What the details of a status say.
struct Details {
  google::rpc::Status status;
  google::rpc::ErrorInfo error_info;
  std::optional<google::rpc::BadRequest> bad_request;
  std::optional<google::rpc::RetryInfo> retry_info;
};
Details details_of(const grpc::Status& status);

}  // namespace weft::server::testing
