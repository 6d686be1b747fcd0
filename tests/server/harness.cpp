// SPDX-License-Identifier: Apache-2.0
#include "tests/server/harness.h"

#include <grpcpp/security/credentials.h>

#include <stdexcept>
#include <thread>

#include "tests/support/connected.h"

namespace weft::server::testing {

Chunk make_chunk(std::uint32_t index, std::size_t bytes) {
  Chunk chunk;
  chunk.index = index;
  chunk.coordinates.resize(bytes / sizeof(double), index);
  chunk.box.add({0, 0});
  return chunk;
}

Result<Summary> send_chunks(ChunkSink& sink, std::uint32_t count, std::size_t bytes) {
  for (std::uint32_t i = 0; i < count; ++i)
    if (!sink.accept(make_chunk(i, bytes))) return fail(ErrorCode::kCancelled, "", "refused");
  Summary summary;
  summary.chunks = count;
  return summary;
}

Result<Summary> send_until_refused(ChunkSink& sink, std::atomic<std::uint32_t>& sent) {
  while (sink.accept(make_chunk(sent, kMaxChunkBytes))) ++sent;
  return fail(ErrorCode::kCancelled, "", "refused");
}

Result<Summary> work_until_stopped(const weft::Run& run) {
  while (true) {
    if (auto error = run.poll()) return tl::unexpected(*error);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));  // as if it worked
  }
}

v1::GenerateMeshRequest valid_request() {
  v1::GenerateMeshRequest request;
  v1::Domain& domain = *request.mutable_domain();
  for (const double c : {0., 0., 4., 0., 4., 4., 0., 4.}) domain.add_points(c);
  for (const std::uint32_t i : {0, 1, 1, 2, 2, 3, 3, 0}) domain.add_segments(i);
  for (const int m : {1, 2, 3, 4}) domain.add_segment_markers(m);
  request.mutable_size()->set_constant(0.1);
  return request;
}

TestServer::TestServer(EngineFn engine, const ServiceOptions& options) {
  auto started = Server::start({.listen = {"127.0.0.1:0"}, .service = options}, std::move(engine),
                               make_logger("off"));
  if (!started) throw std::runtime_error(started.error());
  server_ = std::move(*started);
}

std::shared_ptr<grpc::Channel> TestServer::channel() const {
  grpc::ChannelArguments arguments;
  arguments.SetInt("grpc.use_local_subchannel_pool", 1);  // a connection of its own
  arguments.SetMaxReceiveMessageSize(-1);
  return connected(
      grpc::CreateCustomChannel(address(), grpc::InsecureChannelCredentials(), arguments));
}

std::vector<std::uint32_t> Outcome::chunk_indices() const {
  std::vector<std::uint32_t> indices;
  for (const auto& message : messages)
    if (message.has_chunk()) indices.push_back(message.chunk().index());
  return indices;
}

Outcome read_all(grpc::ClientReader<v1::GenerateMeshResponse>& reader) {
  Outcome outcome;
  v1::GenerateMeshResponse message;
  while (reader.Read(&message)) outcome.messages.push_back(std::move(message));
  outcome.status = reader.Finish();
  return outcome;
}

Outcome call(Stub& stub, const v1::GenerateMeshRequest& request) {
  grpc::ClientContext context;
  return read_all(*stub.GenerateMesh(&context, request));
}

Details details_of(const grpc::Status& status) {
  Details details;
  details.status.ParseFromString(status.error_details());
  for (const auto& any : details.status.details()) {
    any.UnpackTo(&details.error_info);
    google::rpc::BadRequest bad;
    if (any.UnpackTo(&bad)) details.bad_request = bad;
    google::rpc::RetryInfo retry;
    if (any.UnpackTo(&retry)) details.retry_info = retry;
  }
  return details;
}

}  // namespace weft::server::testing
