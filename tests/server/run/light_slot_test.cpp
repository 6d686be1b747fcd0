// SPDX-License-Identifier: Apache-2.0
// Calls whose runs were judged to be light, and are not, on a real server.
#include <atomic>
#include <chrono>
#include <thread>

#include "engine/base/context.h"
#include "server/run/memory_estimate.h"
#include "tests/server/harness.h"

namespace weft::server::testing {
namespace {

constexpr double kHeavySize = 1e-9;   // of a request that is judged heavy
constexpr double kImpostorAngle = 1;  // of one that is not, though its run is
constexpr std::uint64_t kMuchMemory = 2 * kLightBytes;

// An engine for these two, and for all else, which is light. The impostor ends once it runs in the
// arena.
struct Scripted {
  bool grows = false;  // the impostor takes memory; otherwise it takes time
  Event heavy_runs;
  Event heavy_may_end;
  Event impostor_runs;
  std::atomic<int> runs_of_impostor{0};
  std::atomic<int> threads_of_impostor{0};

  Result<Summary> operator()(const MeshRequest& request, ChunkSink& sink, weft::Run& run) {
    if (std::get<double>(request.size.value) == kHeavySize) {
      heavy_runs.set();
      EXPECT_TRUE(heavy_may_end.wait());
    }
    if (request.min_angle_deg == kImpostorAngle) {
      ++runs_of_impostor;
      threads_of_impostor = run.context().threads();
      impostor_runs.set();
      if (grows)
        if (auto error = run.context().need_bytes(kMuchMemory, "the run"))
          return tl::unexpected(*error);
      while (run.context().arena() == nullptr) {
        if (auto error = run.poll()) return tl::unexpected(*error);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    }
    return send_chunks(sink, 1);
  }
};

class LightSlot : public ::testing::TestWithParam<bool> {};

TEST_P(LightSlot, IsLeftByARunThatTurnsOutHeavy) {
  Scripted engine;
  engine.grows = GetParam();
  ServiceOptions options;
  options.threads = 3;
  options.light_jobs = 1;
  TestServer server([&](const MeshRequest& request, ChunkSink& sink,
                        weft::Run& run) { return engine(request, sink, run); },
                    options);
  const auto request = [](double size, double angle) {
    v1::GenerateMeshRequest request = valid_request();
    request.mutable_size()->set_constant(size);
    request.mutable_quality()->set_min_angle_deg(angle);
    return request;
  };
  Outcome heavy;
  std::thread first([&] { heavy = call(*server.stub(), request(kHeavySize, 35)); });
  ASSERT_TRUE(engine.heavy_runs.wait());  // it has the only heavy slot
  Outcome impostor;
  std::thread second([&] { impostor = call(*server.stub(), request(1, kImpostorAngle)); });
  ASSERT_TRUE(engine.impostor_runs.wait());  // and this one the light slot
  const Outcome light = call(*server.stub(), request(1, 20));
  EXPECT_TRUE(light.status.ok()) << light.status.error_message();
  EXPECT_EQ(engine.runs_of_impostor, 1);
  EXPECT_EQ(engine.threads_of_impostor, 1);
  engine.heavy_may_end.set();
  first.join();
  second.join();
  EXPECT_TRUE(heavy.status.ok()) << heavy.status.error_message();
  EXPECT_TRUE(impostor.status.ok()) << impostor.status.error_message();
  EXPECT_EQ(engine.runs_of_impostor, 2);
  EXPECT_EQ(engine.threads_of_impostor, 3) << "in the arena, where turns are taken";
}

TEST_P(LightSlot, OfARunThatIsCancelledWhileItMovesIsLeftForGood) {
  Scripted engine;
  engine.grows = GetParam();
  ServiceOptions options;
  options.light_jobs = 1;
  TestServer server([&](const MeshRequest& request, ChunkSink& sink,
                        weft::Run& run) { return engine(request, sink, run); },
                    options);
  v1::GenerateMeshRequest heavy = valid_request();
  heavy.mutable_size()->set_constant(kHeavySize);
  heavy.mutable_quality()->set_min_angle_deg(35);
  std::thread first([&] { EXPECT_TRUE(call(*server.stub(), heavy).status.ok()); });
  ASSERT_TRUE(engine.heavy_runs.wait());
  v1::GenerateMeshRequest impostor = valid_request();
  impostor.mutable_quality()->set_min_angle_deg(kImpostorAngle);
  grpc::ClientContext context;
  const auto stub = server.stub();
  const auto reader = stub->GenerateMesh(&context, impostor);
  ASSERT_TRUE(engine.impostor_runs.wait());
  EXPECT_TRUE(call(*server.stub(), valid_request()).status.ok());  // so it has left
  context.TryCancel();
  EXPECT_EQ(read_all(*reader).status.error_code(), grpc::StatusCode::CANCELLED);
  EXPECT_TRUE(call(*server.stub(), valid_request()).status.ok());
  engine.heavy_may_end.set();
  first.join();
}

INSTANTIATE_TEST_SUITE_P(By, LightSlot, ::testing::Values(false, true), [](const auto& info) {
  return std::string(info.param ? "Memory" : "Time");
});

}  // namespace
}  // namespace weft::server::testing
