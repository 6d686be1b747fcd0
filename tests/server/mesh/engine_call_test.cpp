// SPDX-License-Identifier: Apache-2.0
// The engine as the server calls it.
#include "server/mesh/engine_call.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "engine/base/context.h"
#include "server/admission/memory_estimate.h"
#include "tests/server/harness.h"

namespace weft::server::testing {
namespace {

class IndexSink final : public ChunkSink {
 public:
  bool accept(Chunk&& chunk) override {
    indices.push_back(chunk.index);
    return true;
  }
  std::vector<std::uint32_t> indices;
};

// Runs this engine as a light one.
struct LightRun {
  explicit LightRun(std::chrono::steady_clock::duration time = std::chrono::minutes(1))
      : call_of_run{.run = run,
                    .memory = memory,
                    .deadline = std::chrono::steady_clock::now() + time,
                    .pool = pool,
                    .threads = 2,
                    .leave_light_lane = [this] { ++left; }} {}

  tl::expected<Summary, Failure> call(const EngineFn& engine) {
    return call_engine(engine, std::make_unique<v1::GenerateMeshRequest>(valid_request()), sink,
                       call_of_run);
  }

  ThreadPool pool{2};
  weft::Run run;
  MemoryGate::Share share;
  RunMemory memory{share, 0};
  IndexSink sink;
  int left = 0;
  EngineRun call_of_run;
};

TEST(EngineCall, RunsWhatIsLightOnTheCallersThread) {
  LightRun light;
  const auto summary = light.call([&](const auto&, ChunkSink& sink, weft::Run& run) {
    EXPECT_EQ(run.context().arena(), nullptr);
    EXPECT_FALSE(run.context().need_bytes(kLightBytes, "the run"));
    return send_chunks(sink, 2);
  });
  EXPECT_TRUE(summary);
  EXPECT_EQ(light.left, 0);
}

TEST(EngineCall, SendsTheChunksOfARunThatBeginsAgainOnce) {
  LightRun light;
  const auto summary =
      light.call([&](const auto&, ChunkSink& sink, weft::Run& run) -> Result<Summary> {
        if (run.context().arena() != nullptr) {
          EXPECT_EQ(light.left, 1);
          return send_chunks(sink, 5);
        }
        EXPECT_TRUE(send_chunks(sink, 3));
        if (auto error = run.context().need_bytes(kLightBytes + 1, "the run"))
          return tl::unexpected(*error);
        return send_chunks(sink, 5);
      });
  EXPECT_TRUE(summary);
  EXPECT_EQ(light.sink.indices, (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
}

// Its own deadline, which comes first, is no reason to begin again.
TEST(EngineCall, EndsALightRunAtItsDeadline) {
  LightRun light(std::chrono::milliseconds(5));
  const auto summary =
      light.call([](const auto&, ChunkSink&, weft::Run& run) { return work_until_stopped(run); });
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().reason, Reason::kDeadlineExceeded);
  EXPECT_EQ(light.left, 0);
}

TEST(EngineCall, EndsALightRunThatIsCancelled) {
  LightRun light;
  const auto summary = light.call([&](const auto&, ChunkSink&, weft::Run& run) {
    run.cancel();
    return work_until_stopped(run);
  });
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().reason, Reason::kCancelled);
  EXPECT_EQ(light.left, 0);
}

}  // namespace
}  // namespace weft::server::testing
