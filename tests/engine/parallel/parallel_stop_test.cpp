// SPDX-License-Identifier: Apache-2.0
// Every way to end a run early, on several threads.
#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <random>
#include <thread>

#include "tests/engine/parallel/parallel.h"
#include "tests/support/processor_time.h"

namespace weft {
namespace {

using Clock = ExecutionContext::Clock;

// Of all threads together.
const double kPromptly = (kSanitized ? 10 : 1) * slowdown();  // s

double seconds_of_all_threads() {
  return processor_seconds(CLOCK_PROCESS_CPUTIME_ID);
}

// Too large to be done before the tests are.
MeshRequest endless() {
  return busy_square(1e8, 1000);
}

class ParallelStops : public testing::TestWithParam<int> {
 protected:
  Arena arena_{GetParam()};
};

TEST_P(ParallelStops, ByCancellationAreNoticedPromptly) {
  for (const std::uint64_t triangles : {1'000, 20'000, 200'000}) {
    SCOPED_TRACE(triangles);
    ExecutionContext context;
    context.set_arena(arena_);
    double cancelled = 0;
    std::atomic<bool> over{false};
    std::thread canceller([&] {
      while (context.progress().triangles < triangles && !over) std::this_thread::yield();
      context.cancel();
      cancelled = seconds_of_all_threads();
    });
    ForgetfulSink sink;
    const auto summary = generate_mesh(endless(), sink, context);
    const double ended = seconds_of_all_threads();
    over = true;
    canceller.join();
    ASSERT_FALSE(summary);
    EXPECT_EQ(summary.error().code, ErrorCode::kCancelled);
    EXPECT_LT(ended - cancelled, kPromptly);
  }
}

TEST_P(ParallelStops, ByTheDeadlineAreNoticedPromptly) {
  ExecutionContext context;
  context.set_arena(arena_);
  const auto deadline = Clock::now() + std::chrono::milliseconds(100);
  context.set_deadline(deadline);
  double passed = 0;
  std::thread watch([&] {
    std::this_thread::sleep_until(deadline);
    passed = seconds_of_all_threads();
  });
  ForgetfulSink sink;
  const auto summary = generate_mesh(endless(), sink, context);
  const double ended = seconds_of_all_threads();
  watch.join();
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().code, ErrorCode::kDeadlineExceeded);
  EXPECT_LT(ended - passed, kPromptly);
}

TEST_P(ParallelStops, ByTheBudgetOfBytesNameIt) {
  ExecutionContext context({.max_bytes = 8 << 20});
  context.set_arena(arena_);
  ForgetfulSink sink;
  const auto summary = generate_mesh(busy_square(1e6, 1000), sink, context);
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().code, ErrorCode::kBudgetExceeded);
  EXPECT_EQ(summary.error().field, "budget.max_bytes");
}

TEST_P(ParallelStops, ByTheTriangleLimitHappenBelowTheMeshesCountAndNotAtIt) {
  const MeshRequest request = busy_square(30'000, 200);
  const auto unlimited = mesh_on(&arena_, request);
  ASSERT_TRUE(unlimited);
  for (const bool enough : {false, true}) {
    ExecutionContext context({.triangle_limit = unlimited->triangles - (enough ? 0 : 1)});
    context.set_arena(arena_);
    ForgetfulSink sink;
    const auto summary = generate_mesh(request, sink, context);
    ASSERT_EQ(summary.has_value(), enough);
    if (enough) {
      EXPECT_EQ(summary->digest, unlimited->digest);
    } else {
      EXPECT_EQ(summary.error().code, ErrorCode::kLimitExceeded);
    }
  }
}

TEST_P(ParallelStops, ByTheSinkComeAfterTheChunkItRefused) {
  struct Refuses : ChunkSink {
    bool accept(Chunk&&) override { return ++taken <= most; }
    int most = 0;
    int taken = 0;
  };
  for (const int most : {0, 1, 2, 5, 40}) {
    Refuses sink;
    sink.most = most;
    const auto summary = mesh_on(&arena_, busy_square(60'000, 500), sink);
    ASSERT_FALSE(summary);
    EXPECT_EQ(summary.error().code, ErrorCode::kCancelled);
    EXPECT_EQ(sink.taken, most + 1);
  }
}

INSTANTIATE_TEST_SUITE_P(On, ParallelStops, testing::Values(1, 2, 4, 16),
                         [](const auto& info) { return std::to_string(info.param) + "Threads"; });

struct Memory {
  std::int64_t resident;   // bytes
  std::int64_t allocated;  // bytes, by malloc
};

Memory memory() {
  std::ifstream statm("/proc/self/statm");
  std::int64_t total = 0;
  std::int64_t resident = 0;
  statm >> total >> resident;
  const auto info = mallinfo2();
  return {resident * sysconf(_SC_PAGESIZE), static_cast<std::int64_t>(info.uordblks + info.hblkhd)};
}

// Holds a run that has come so far until it is cancelled: on a busy machine it would be done before
// its canceller gets a turn.
class HoldsAt final : public MemorySource {
 public:
  HoldsAt(const ExecutionContext& run, std::uint64_t triangles)
      : run_(run), triangles_(triangles) {}
  Result<std::uint64_t> grant(std::uint64_t needed, const Poll& poll) override {
    while (run_.progress().triangles >= triangles_) {
      if (auto error = poll()) return tl::unexpected(*error);
      std::this_thread::yield();
    }
    return needed;
  }

 private:
  const ExecutionContext& run_;
  const std::uint64_t triangles_;
};

TEST(ParallelStop, AThousandCancelledJobsLeaveNothingBehind) {
  const int jobs = static_cast<int>((kSanitized ? 100 : 1000) / slowdown());
  const MeshRequest request = busy_square(8'000, 200);
  Arena arena(4);
  const auto whole = mesh_on(&arena, request);
  ASSERT_TRUE(whole);
  std::mt19937_64 random(3);
  Memory early{};
  for (int job = 0; job < jobs; ++job) {
    if (job == jobs / 5) early = memory();
    ExecutionContext context;
    context.set_arena(arena);
    const std::uint64_t moment = random() % (whole->triangles * 9 / 10);
    HoldsAt source(context, moment);
    context.set_memory(source, 0);
    std::atomic<bool> over{false};
    std::thread canceller([&] {
      while (context.progress().triangles < moment && !over) std::this_thread::yield();
      context.cancel();
    });
    ForgetfulSink sink;
    const auto summary = generate_mesh(request, sink, context);
    over = true;
    canceller.join();
    ASSERT_FALSE(summary);
    ASSERT_EQ(summary.error().code, ErrorCode::kCancelled) << summary.error().message;
  }
  const Memory late = memory();
  if (!kSanitized) {
    // One leaked mesh in a hundred would be more. What qemu holds is its own: some of each thread.
    if (slowdown() == 1) {
      EXPECT_LT(late.resident - early.resident, 16 << 20);
    }
    EXPECT_LT(late.allocated - early.allocated, 2 << 20);
  }
  EXPECT_EQ(outcome(mesh_on(&arena, request)), outcome(whole));
}

}  // namespace
}  // namespace weft
