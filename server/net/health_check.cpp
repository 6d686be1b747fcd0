// SPDX-License-Identifier: Apache-2.0
#include "server/net/health_check.h"

#include <grpcpp/client_context.h>
#include <grpcpp/completion_queue.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/support/byte_buffer.h>

#include <chrono>
#include <string_view>
#include <vector>

namespace weft::server {
namespace {

constexpr std::chrono::seconds kTimeout{10};
// HealthCheckResponse with status SERVING.
constexpr std::string_view kServing = "\x08\x01";

std::string bytes_of(const grpc::ByteBuffer& buffer) {
  std::vector<grpc::Slice> slices;
  std::string bytes;
  if (buffer.Dump(&slices).ok())
    for (const grpc::Slice& slice : slices) bytes.append(slice.begin(), slice.end());
  return bytes;
}

}  // namespace

tl::expected<void, std::string> check_health(const std::string& address) {
  grpc::GenericStub stub(grpc::CreateChannel(address, grpc::InsecureChannelCredentials()));
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + kTimeout);
  grpc::CompletionQueue queue;
  const grpc::Slice whole_server;
  const grpc::ByteBuffer request(&whole_server, 1);
  const auto call =
      stub.PrepareUnaryCall(&context, "/grpc.health.v1.Health/Check", request, &queue);
  call->StartCall();
  grpc::ByteBuffer response;
  grpc::Status status;
  call->Finish(&response, &status, nullptr);
  void* tag = nullptr;
  bool ok = false;
  queue.Next(&tag, &ok);
  if (!status.ok()) return tl::unexpected(address + ": " + status.error_message());
  if (bytes_of(response) != kServing) return tl::unexpected(address + " is not serving");
  return {};
}

}  // namespace weft::server
