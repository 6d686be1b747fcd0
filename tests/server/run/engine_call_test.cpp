// SPDX-License-Identifier: Apache-2.0
// The engine as the server calls it.
#include "server/run/engine_call.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "engine/base/context.h"
#include "server/run/memory_estimate.h"
#include "server/wire/translate.h"
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

// Runs an engine in a light slot of a queue, with a heavy one free.
struct LightRun {
  explicit LightRun(std::chrono::steady_clock::duration time = std::chrono::minutes(1))
      : deadline(std::chrono::steady_clock::now() + time) {}

  tl::expected<Summary, Failure> call(const EngineFn& engine) {
    tl::expected<Summary, Failure> outcome;
    RunQueue queue({.light_slots = 1, .capacity = 1, .max_light_estimate = 1});
    Event ended;
    queue.push({}, [&](RunQueue::Slot& slot) {
      outcome = call_engine(engine, *to_engine(valid_request()), sink,
                            {.run = run,
                             .slot = slot,
                             .besides = 0,
                             .deadline = deadline,
                             .pool = pool,
                             .threads = 2});
      was_promoted = slot.priority() == RunQueue::PriorityClass::kHeavy;
      ended.set();
    });
    EXPECT_TRUE(ended.wait());
    return outcome;
  }

  std::chrono::steady_clock::time_point deadline;
  ThreadPool pool{2};
  weft::Run run;
  IndexSink sink;
  bool was_promoted = false;
};

TEST(EngineCall, RunsWhatIsLightOnTheCallersThread) {
  LightRun light;
  const auto summary = light.call([&](const auto&, ChunkSink& sink, weft::Run& run) {
    EXPECT_EQ(run.context().arena(), nullptr);
    EXPECT_FALSE(run.context().need_bytes(kLightBytes, "the run"));
    return send_chunks(sink, 2);
  });
  EXPECT_TRUE(summary);
  EXPECT_FALSE(light.was_promoted);
}

TEST(EngineCall, SendsTheChunksOfARunThatBeginsAgainOnce) {
  LightRun light;
  const auto summary =
      light.call([&](const auto&, ChunkSink& sink, weft::Run& run) -> Result<Summary> {
        if (run.context().arena() != nullptr) return send_chunks(sink, 5);
        EXPECT_TRUE(send_chunks(sink, 3));
        if (auto error = run.context().need_bytes(kLightBytes + 1, "the run"))
          return tl::unexpected(*error);
        return send_chunks(sink, 5);
      });
  EXPECT_TRUE(summary);
  EXPECT_TRUE(light.was_promoted);
  EXPECT_EQ(light.sink.indices, (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
}

// Its own deadline, which comes first, is no reason to begin again.
TEST(EngineCall, EndsALightRunAtItsDeadline) {
  LightRun light(std::chrono::milliseconds(5));
  const auto summary =
      light.call([](const auto&, ChunkSink&, weft::Run& run) { return work_until_stopped(run); });
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().reason, Reason::kDeadlineExceeded);
  EXPECT_FALSE(light.was_promoted);
}

TEST(EngineCall, EndsALightRunThatIsCancelled) {
  LightRun light;
  const auto summary = light.call([&](const auto&, ChunkSink&, weft::Run& run) {
    run.cancel();
    return work_until_stopped(run);
  });
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().reason, Reason::kCancelled);
  EXPECT_FALSE(light.was_promoted);
}

}  // namespace
}  // namespace weft::server::testing
