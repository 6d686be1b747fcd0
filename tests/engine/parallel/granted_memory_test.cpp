// SPDX-License-Identifier: Apache-2.0
// Runs that are granted their memory as they grow.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <random>
#include <thread>
#include <utility>

#include "tests/engine/parallel/parallel.h"
#include "tests/support/event.h"

namespace weft {
namespace {

// Grants what is asked for and no more; now and then late.
class Stingy final : public MemorySource {
 public:
  Result<std::uint64_t> grant(std::uint64_t needed, const Poll&) override {
    std::uint64_t most = most_.load();
    while (most < needed && !most_.compare_exchange_weak(most, needed)) {
    }
    if (++asked_ % 7 == 0) std::this_thread::sleep_for(std::chrono::microseconds(200));
    return needed;
  }
  std::uint64_t most() const { return most_; }
  int asked() const { return asked_; }

 private:
  std::atomic<std::uint64_t> most_{0};
  std::atomic<int> asked_{0};
};

TEST(GrantedMemory, ChangesNothingInTheMesh) {
  const MeshRequest request = busy_square(60'000, 200);
  const std::string alone = outcome(mesh_on(nullptr, request));
  for (const int threads : {1, 2, 3}) {
    Arena arena(threads);
    ExecutionContext context;
    context.set_arena(arena);
    Stingy source;
    context.set_memory(source, 0);
    ForgetfulSink sink;
    EXPECT_EQ(outcome(generate_mesh(request, sink, context)), alone) << threads;
    EXPECT_GT(source.asked(), 10);
  }
}

// Peaks of fragments are added up in the summary, so that it may say more: of a mesh of few
// fragments by a half, the more the later the sender's thread comes.
TEST(GrantedMemory, IsNearlyAllThatTheSummaryTellsOf) {
  for (const auto& [triangles, least] : {std::pair(100'000.0, 0.4), {2'000'000.0, 0.9}}) {
    Arena arena(1);
    ExecutionContext context;
    context.set_arena(arena);
    Stingy source;
    context.set_memory(source, 0);
    ForgetfulSink sink;
    const auto summary = generate_mesh({.pslg = square(), .size = 1.04 / triangles}, sink, context);
    ASSERT_TRUE(summary);
    const auto peak = static_cast<double>(summary->peak_bytes);
    const auto asked = static_cast<double>(source.most());
    EXPECT_GT(asked, least * peak) << triangles;
    EXPECT_LT(asked, 1.05 * peak) << triangles;
    EXPECT_EQ(context.held_bytes().now(), 0) << triangles;
  }
}

// Grants nothing beyond a limit until it is told to go on.
class Waits final : public MemorySource {
 public:
  Result<std::uint64_t> grant(std::uint64_t needed, const Poll& poll) override {
    if (needed <= kLimit) return needed;
    waits.set();
    while (!go_on) {
      if (auto error = poll()) return tl::unexpected(*error);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return needed;
  }
  static constexpr std::uint64_t kLimit = std::uint64_t{2} << 20;
  Event waits;
  std::atomic<bool> go_on{false};
};

TEST(GrantedMemory, HoldsBackNoOtherRunWhileOneWaits) {
  const MeshRequest large = busy_square(200'000, 4'000);
  const MeshRequest small = busy_square(5'000, 200);
  const std::string large_alone = outcome(mesh_on(nullptr, large));
  const std::string small_alone = outcome(mesh_on(nullptr, small));
  for (const int threads : {1, 2, 4}) {
    Arena arena(threads);
    Waits source;
    std::string first;
    std::thread run([&] {
      ExecutionContext context;
      context.set_arena(arena);
      context.set_memory(source, 0);
      ForgetfulSink sink;
      first = outcome(generate_mesh(large, sink, context));
    });
    EXPECT_TRUE(source.waits.wait());
    EXPECT_EQ(outcome(mesh_on(&arena, small)), small_alone) << threads;
    source.go_on = true;
    run.join();
    EXPECT_EQ(first, large_alone) << threads;
  }
}

TEST(GrantedMemory, CanBeWaitedForUntilTheRunIsCancelled) {
  Arena arena(2);
  Waits source;
  ExecutionContext context;
  context.set_arena(arena);
  context.set_memory(source, 0);
  std::thread canceller([&] {
    EXPECT_TRUE(source.waits.wait());
    context.cancel();
  });
  ForgetfulSink sink;
  const auto summary = generate_mesh(busy_square(200'000, 4'000), sink, context);
  canceller.join();
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().code, ErrorCode::kCancelled);
}

struct Refuses final : MemorySource {
  Result<std::uint64_t> grant(std::uint64_t needed, const Poll&) override {
    if (needed > Waits::kLimit) return fail(ErrorCode::kOutOfMemory, "", "no more");
    return needed;
  }
};

TEST(GrantedMemory, EndsTheRunWithWhatTheSourceSays) {
  Refuses source;
  for (const int threads : {1, 2}) {
    Arena arena(threads);
    ExecutionContext context;
    context.set_arena(arena);
    context.set_memory(source, 0);
    ForgetfulSink sink;
    const auto summary = generate_mesh(busy_square(200'000, 4'000), sink, context);
    ASSERT_FALSE(summary);
    EXPECT_EQ(summary.error().message, "no more");
  }
}

// A domain of many points takes memory before anything is refined.
TEST(GrantedMemory, IsAskedForBeforeTheDomainIsTriangulated) {
  Pslg pslg = square();
  std::mt19937 random(1);
  for (int i = 0; i < 20'000; ++i)
    pslg.points.push_back(
        {0.1 + 0.8 * (random() / 4294967296.0), 0.1 + 0.8 * (random() / 4294967296.0)});
  struct First final : MemorySource {
    Result<std::uint64_t> grant(std::uint64_t needed, const Poll&) override {
      if (asked == 0) asked = needed;
      return needed;
    }
    std::uint64_t asked = 0;
  } source;
  ExecutionContext context;
  context.set_memory(source, 0);
  ForgetfulSink sink;
  ASSERT_TRUE(generate_mesh({.pslg = pslg}, sink, context));
  EXPECT_GT(source.asked, 20'000 * 200);
}

// Before it had done anything, and in the middle.
TEST(Context, ServesAJobThatBeginsAgain) {
  const MeshRequest request = busy_square(200'000, 4'000);
  const std::string expected = outcome(mesh_on(nullptr, request));
  for (const ErrorCode stop : {ErrorCode::kDeadlineExceeded, ErrorCode::kOutOfMemory}) {
    Arena arena(2);
    ExecutionContext context;
    Refuses poor;
    if (stop == ErrorCode::kOutOfMemory) {
      context.set_memory(poor, 0);
    } else {
      context.set_deadline(ExecutionContext::Clock::now());
    }
    ForgetfulSink sink;
    const auto first = generate_mesh(request, sink, context);
    ASSERT_FALSE(first);
    EXPECT_EQ(first.error().code, stop);
    EXPECT_EQ(context.progress().triangles > 0, stop == ErrorCode::kOutOfMemory);
    context.begin_again();
    EXPECT_EQ(context.progress().stage, Stage::kQueued);
    EXPECT_EQ(context.progress().triangles, 0);
    context.set_deadline(ExecutionContext::Clock::now() + std::chrono::hours(1));
    Stingy enough;
    context.set_memory(enough, 0);
    context.set_arena(arena);
    const auto again = generate_mesh(request, sink, context);
    EXPECT_EQ(outcome(again), expected);
    ASSERT_TRUE(again);
    EXPECT_EQ(context.progress().triangles, again->triangles);
  }
}

TEST(Context, ReportsNoSmallerFractionIfItsRunBeginsAgain) {
  ExecutionContext context;
  context.add_fraction(0.4);
  context.begin_again();
  EXPECT_EQ(context.progress().fraction, 0.4);
  context.add_fraction(0.3);
  EXPECT_EQ(context.progress().fraction, 0.4);
  context.add_fraction(0.3);
  EXPECT_EQ(context.progress().fraction, 0.6);
}

TEST(Context, StaysCancelledIfItsJobBeginsAgain) {
  ExecutionContext context;
  context.cancel();
  context.begin_again();
  ASSERT_TRUE(context.poll());
  EXPECT_EQ(context.poll()->code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace weft
