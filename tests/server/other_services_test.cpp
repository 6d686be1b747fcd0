// SPDX-License-Identifier: Apache-2.0
// grpc.health.v1 and reflection, with requests and responses spelled in wire bytes.
#include <thread>

#include "tests/server/harness.h"
#include "tests/server/raw_call.h"

namespace weft::server::testing {
namespace {

constexpr const char* kCheck = "/grpc.health.v1.Health/Check";
// HealthCheckResponse.status
const std::string kServing("\x08\x01", 2);
const std::string kNotServing("\x08\x02", 2);

EngineFn idle() {
  return [](const auto&, ChunkSink& sink, auto&) { return send_chunks(sink, 0); };
}

TEST(Health, SaysServingForTheServerAndForTheService) {
  TestServer server(idle());
  const auto [whole, whole_answer] = raw_unary(server.channel(), kCheck, "");
  EXPECT_TRUE(whole.ok()) << whole.error_message();
  EXPECT_EQ(whole_answer, kServing);
  const std::string name = "weft.v1.MeshService";
  const auto [one, one_answer] =
      raw_unary(server.channel(), kCheck, std::string{'\x0a', char(name.size())} + name);
  EXPECT_TRUE(one.ok()) << one.error_message();
  EXPECT_EQ(one_answer, kServing);
}

TEST(Health, SaysNotServingWhileTheServerDrains) {
  Event release;
  Event started;
  TestServer server([&](const auto&, ChunkSink& sink, auto&) {
    started.set();
    EXPECT_TRUE(release.wait());
    return send_chunks(sink, 0);
  });
  auto stub = server.stub();
  grpc::ClientContext context;
  auto reader = stub->GenerateMesh(&context, valid_request());
  ASSERT_TRUE(started.wait());
  const auto channel = server.channel();
  std::thread drainer([&] { server->drain(std::chrono::seconds(30)); });
  std::string answer;
  do answer = raw_unary(channel, kCheck, "").second;
  while (answer == kServing);
  EXPECT_EQ(answer, kNotServing);
  release.set();
  EXPECT_TRUE(read_all(*reader).status.ok());
  drainer.join();
}

TEST(Reflection, ListsTheService) {
  TestServer server(idle());
  const auto channel = server.channel();
  grpc::ClientContext context;
  const grpc::internal::RpcMethod rpc(
      "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo",
      grpc::internal::RpcMethod::BIDI_STREAMING, channel);
  const std::unique_ptr<grpc::ClientReaderWriter<grpc::ByteBuffer, grpc::ByteBuffer>> stream(
      grpc::internal::ClientReaderWriterFactory<grpc::ByteBuffer, grpc::ByteBuffer>::Create(
          channel.get(), rpc, &context));
  const std::string list_services("\x3a\x00", 2);
  ASSERT_TRUE(stream->Write(to_buffer(list_services)));
  grpc::ByteBuffer answer;
  ASSERT_TRUE(stream->Read(&answer));
  EXPECT_NE(to_string(answer).find("weft.v1.MeshService"), std::string::npos);
  stream->WritesDone();
  EXPECT_TRUE(stream->Finish().ok());
}

}  // namespace
}  // namespace weft::server::testing
