// SPDX-License-Identifier: Apache-2.0
// Calls of any method with any bytes.
#pragma once

#include <grpcpp/channel.h>
#include <grpcpp/impl/codegen/client_unary_call.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/sync_stream.h>

#include <chrono>
#include <memory>
#include <string>
#include <utility>

namespace weft::server::testing {

inline grpc::ByteBuffer to_buffer(const std::string& bytes) {
  const grpc::Slice slice(bytes);
  return {&slice, 1};
}

inline std::string to_string(const grpc::ByteBuffer& buffer) {
  grpc::Slice slice;
  if (!buffer.Valid() || !buffer.DumpToSingleSlice(&slice).ok()) return {};
  return {reinterpret_cast<const char*>(slice.begin()), slice.size()};
}

// A unary call.
inline std::pair<grpc::Status, std::string> raw_unary(const std::shared_ptr<grpc::Channel>& channel,
                                                      const char* method,
                                                      const std::string& request,
                                                      const std::string& authorization = "") {
  grpc::ClientContext context;
  if (!authorization.empty()) context.AddMetadata("authorization", authorization);
  grpc::ByteBuffer response;
  const grpc::internal::RpcMethod rpc(method, grpc::internal::RpcMethod::NORMAL_RPC, channel);
  grpc::Status status = grpc::internal::BlockingUnaryCall<grpc::ByteBuffer, grpc::ByteBuffer>(
      channel.get(), rpc, &context, to_buffer(request), &response);
  return {std::move(status), to_string(response)};
}

// A call that may answer with any number of messages; its deadline is a minute.
class RawStream {
 public:
  RawStream(std::shared_ptr<grpc::Channel> channel, const char* method, const std::string& request,
            const std::string& authorization = "")
      : channel_(std::move(channel)),
        rpc_(method, grpc::internal::RpcMethod::SERVER_STREAMING, channel_) {
    context_.set_deadline(std::chrono::system_clock::now() + std::chrono::minutes(1));
    if (!authorization.empty()) context_.AddMetadata("authorization", authorization);
    reader_.reset(grpc::internal::ClientReaderFactory<grpc::ByteBuffer>::Create(
        channel_.get(), rpc_, &context_, to_buffer(request)));
  }

  bool read() {
    grpc::ByteBuffer message;
    return reader_->Read(&message);
  }
  grpc::Status end() {
    while (read()) continue;
    return reader_->Finish();
  }

 private:
  const std::shared_ptr<grpc::Channel> channel_;
  const grpc::internal::RpcMethod rpc_;
  grpc::ClientContext context_;
  std::unique_ptr<grpc::ClientReader<grpc::ByteBuffer>> reader_;
};

// One that is read to its end.
inline grpc::Status raw_stream(const std::shared_ptr<grpc::Channel>& channel, const char* method,
                               const std::string& request) {
  return RawStream(channel, method, request).end();
}

// GenerateMesh, read to its end.
inline grpc::Status raw_generate_mesh(const std::shared_ptr<grpc::Channel>& channel,
                                      const std::string& request) {
  return raw_stream(channel, "/weft.v1.MeshService/GenerateMesh", request);
}

}  // namespace weft::server::testing
