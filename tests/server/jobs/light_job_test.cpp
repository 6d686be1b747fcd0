// SPDX-License-Identifier: Apache-2.0
// Jobs that are light, or were judged so, beside heavy ones.
#include <atomic>
#include <chrono>
#include <thread>

#include "engine/base/context.h"
#include "tests/server/job_harness.h"

namespace weft::server::testing {
namespace {

constexpr double kHeavySize = 1e-9;
constexpr double kImpostorAngle = 1;

v1::GenerateMeshRequest request(double size, double angle) {
  v1::GenerateMeshRequest request = valid_request();
  request.mutable_size()->set_constant(size);
  request.mutable_quality()->set_min_angle_deg(angle);
  return request;
}

// One slot, and one for light jobs.
TEST(LightJob, LeavesItsSlotIfItTurnsOutHeavy) {
  Event heavy_runs;
  Event heavy_may_end;
  Event impostor_runs;
  std::atomic<int> runs_in_arena{0};
  std::atomic<bool> light_in_arena{false};
  ServiceOptions service;
  service.jobs = 1;
  service.light_jobs = 1;
  JobServer server(
      [&](const MeshRequest& request, ChunkSink& sink, weft::Run& run) -> Result<Summary> {
        if (std::get<double>(request.size.value) == kHeavySize) {
          heavy_runs.set();
          EXPECT_TRUE(heavy_may_end.wait());
          return send_chunks(sink, 1);
        }
        const bool in_arena = run.context().arena() != nullptr;
        if (request.min_angle_deg != kImpostorAngle) {
          light_in_arena = in_arena;
        } else {
          impostor_runs.set();
          runs_in_arena += in_arena;
          while (!in_arena) {
            if (auto error = run.poll()) return tl::unexpected(*error);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
          }
        }
        return send_chunks(sink, 1);
      },
      quick_jobs(), {}, service);
  JobClient client = server.client();
  const auto heavy = client.submit(request(kHeavySize, 35));
  ASSERT_TRUE(heavy_runs.wait());
  const auto impostor = client.submit(request(1, kImpostorAngle));
  ASSERT_TRUE(impostor_runs.wait());
  const v1::Job light = client.wait(client.submit(request(1, 20)));
  EXPECT_EQ(light.state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_FALSE(light_in_arena);
  EXPECT_EQ(runs_in_arena, 0) << "it waits for the slot";
  heavy_may_end.set();
  EXPECT_EQ(client.wait(heavy).state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(client.wait(impostor).state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(runs_in_arena, 1);
}

}  // namespace
}  // namespace weft::server::testing
