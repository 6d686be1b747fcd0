// SPDX-License-Identifier: Apache-2.0
#include "server/mesh/mesh_call.h"

#include "tests/server/job_harness.h"

namespace weft::server::testing {
namespace {

TEST(MeshCall, KeepsMemoryForWhatWaitsForItsReader) {
  constexpr double kMiB = 1 << 20;
  const std::string bytes = "weft_admission_bytes{queue=\"calls\"}";
  Event made;
  JobServer server([&](const auto&, ChunkSink& sink, auto&) {
    auto summary = send_chunks(sink, 8, kMaxChunkBytes / 2);
    made.set();
    return summary;
  });
  const auto stub = v1::MeshService::NewStub(server.channel());
  grpc::ClientContext context;
  const auto reader = stub->GenerateMesh(&context, valid_request());
  ASSERT_TRUE(made.wait());
  EXPECT_TRUE(eventually([&] { return server.metric("weft_running_jobs{queue=\"calls\"}") == 0; }));
  EXPECT_GT(server.metric(bytes), kMiB);
  v1::GenerateMeshResponse message;
  while (reader->Read(&message)) continue;
  EXPECT_TRUE(reader->Finish().ok());
  EXPECT_TRUE(eventually([&] { return server.metric(bytes) == 0; }));
}

}  // namespace
}  // namespace weft::server::testing
