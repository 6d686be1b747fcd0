// SPDX-License-Identifier: Apache-2.0
#include "engine/base/arena.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "tests/support/event.h"

namespace weft {
namespace {

TEST(Arena, RunsOnItsOwnThreadsWhileTheCallerWaits) {
  Arena arena(2);
  const auto caller = std::this_thread::get_id();
  EXPECT_NE(arena.run([] { return std::this_thread::get_id(); }), caller);
}

// With one thread, waiting for another would be waiting for ever.
TEST(Arena, RunsAtOnceWhatIsRunFromWithin) {
  Arena arena(1);
  const bool same = arena.run([&] {
    const auto outer = std::this_thread::get_id();
    return arena.run([&] { return std::this_thread::get_id() == outer; });
  });
  EXPECT_TRUE(same);
}

TEST(Arena, RunsAtOnceWhatAStartedFunctionRuns) {
  Arena arena(1);
  Event done;
  int ran = 0;
  arena.start([&] {
    arena.for_each(3, 1, [&](std::size_t) { arena.run([&] { ++ran; }); });
    done.set();
  });
  done.wait();
  EXPECT_EQ(ran, 3);
}

TEST(Arena, RunsAtOnceWhatTheStepsOfALoopRun) {
  Arena arena(2);
  std::atomic<int> elsewhere = 0;
  arena.for_each(200, 2, [&](std::size_t) {
    const auto step = std::this_thread::get_id();
    std::this_thread::yield();
    if (arena.run([] { return std::this_thread::get_id(); }) != step) ++elsewhere;
  });
  EXPECT_EQ(elsewhere, 0);
}

TEST(Arena, LetsOthersComputeWhileItsThreadsRest) {
  Arena arena(2);
  EXPECT_EQ(arena.threads(), 2);
  Event all_rest;
  Event may_go_on;
  std::atomic<int> resting = 0;
  std::vector<std::thread> callers;
  for (int i = 0; i < 5; ++i)
    callers.emplace_back([&] {
      arena.run([&] {
        arena.rest([&] {
          if (++resting == 5) all_rest.set();
          EXPECT_TRUE(may_go_on.wait());
        });
      });
    });
  EXPECT_TRUE(all_rest.wait());
  std::atomic<int> running = 0;
  std::atomic<int> most = 0;
  for (int i = 0; i < 6; ++i)
    callers.emplace_back([&] {
      arena.run([&] {
        const int now = ++running;
        for (int before = most; before < now && !most.compare_exchange_weak(before, now);) continue;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        --running;
      });
    });
  for (std::size_t i = 5; i < callers.size(); ++i) callers[i].join();
  EXPECT_LE(most, 2);
  may_go_on.set();
  for (std::size_t i = 0; i < 5; ++i) callers[i].join();
}

TEST(Arena, ThrowsWhatItsFunctionThrows) {
  Arena arena(2);
  EXPECT_THROW(arena.run([] { throw std::runtime_error("no"); }), std::runtime_error);
  EXPECT_THROW(arena.for_each(9, 2,
                              [](std::size_t i) {
                                if (i == 5) throw std::runtime_error("no");
                              }),
               std::runtime_error);
  EXPECT_EQ(arena.run([] { return 7; }), 7);
}

TEST(Arena, ReturnsWhatCanOnlyBeMoved) {
  Arena arena(1);
  EXPECT_EQ(*arena.run([] { return std::make_unique<int>(7); }), 7);
}

TEST(Arena, RunsEachStepOfALoopOnce) {
  Arena arena(3);
  std::vector<std::atomic<int>> steps(1000);
  arena.for_each(steps.size(), 3, [&](std::size_t i) { ++steps[i]; });
  for (const auto& count : steps) EXPECT_EQ(count, 1);
}

}  // namespace
}  // namespace weft
