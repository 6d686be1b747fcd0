// SPDX-License-Identifier: Apache-2.0
// Runs that a RunQueue gets from a Source, beside those that are pushed.
#include <gtest/gtest.h>

#include <atomic>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "server/run/memory_budget.h"
#include "server/run/run_queue.h"
#include "tests/server/run/runs.h"
#include "tests/support/event.h"

namespace weft::server {
namespace {

TEST(RunsOfASource, HaveTheSlotsInTurnsWithThoseThatWaitHere) {
  std::string order;
  Event done;
  Busy busy;
  MemoryBudget budget({}, [] {});
  RunQueue queue({.capacity = 100, .memory = &budget});
  ListSource source(queue);
  busy.occupy(queue);
  const auto ran = [&](char what) {
    order += what;
    if (order.size() == 7) done.set();
  };
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(pushed(queue, plain([&] { ran('c'); }), i == 0 ? "a" : "b"));
    source.add("a", 0, [&](auto&) { ran('j'); });
  }
  source.add("a", 0, [&](auto&) { ran('j'); });
  busy.release.set();
  ASSERT_TRUE(done.wait());
  EXPECT_EQ(order, "jcjcjcj");
}

TEST(RunsOfASource, AreBoundedByTheSlotsThatAllShare) {
  constexpr int kRuns = 20;
  std::atomic<int> running{0};
  std::atomic<int> left{2 * kRuns};
  Event done;
  MemoryBudget budget({}, [] {});
  RunQueue queue({.slots = 2, .capacity = 100, .memory = &budget});
  ListSource source(queue);
  const auto run = [&](auto&) {
    EXPECT_LE(++running, 2);
    std::this_thread::yield();
    --running;
    if (--left == 0) done.set();
  };
  for (int i = 0; i < kRuns; ++i) {
    ASSERT_TRUE(pushed(queue, run, "a"));
    source.add("b", 0, run);
  }
  EXPECT_TRUE(done.wait());
}

TEST(RunsOfASource, CountTowardsTheSlotsOfTheirClientWithThoseThatWaitHere) {
  Event both_run;
  Event third_runs;
  Event one_may_end;
  Event other_may_end;
  std::atomic<int> running{0};
  MemoryBudget budget({}, [] {});
  RunQueue queue({.slots = 4, .capacity = 100, .memory = &budget, .client_share = 0.5});
  ListSource source(queue);
  const auto run = [&](Event& may_end) {
    if (++running == 2) both_run.set();
    EXPECT_TRUE(may_end.wait());
  };
  ASSERT_TRUE(pushed(queue, plain([&] { run(one_may_end); }), "a"));
  source.add("a", 0, [&](auto&) { run(other_may_end); });
  ASSERT_TRUE(both_run.wait());
  source.add("a", 0, [&](auto&) { third_runs.set(); });
  Event of_another;
  source.add("b", 0, [&](RunQueue::Slot& slot) {
    EXPECT_EQ(slot.full_clients(), std::vector<std::string>{"a"});
    of_another.set();
  });
  EXPECT_TRUE(of_another.wait());
  EXPECT_FALSE(third_runs.happened());
  one_may_end.set();
  EXPECT_TRUE(third_runs.wait()) << "the source was not asked again";
  other_may_end.set();
}

TEST(RunsOfASource, WaitWithARunThatWasBypassedTooOften) {
  MemoryBudget budget({.capacity = 100}, [] {});
  auto reserved = budget.reserve({.estimate = 50});
  std::atomic<int> of_source{0};
  Event large_ran;
  Event all_ran;
  constexpr int kRuns = 500;
  RunQueue queue({.slots = 1, .capacity = 10, .memory = &budget});
  Busy busy;
  busy.occupy(queue);
  queue.push({.client = "large", .estimate = 60}, plain([&] { large_ran.set(); }));
  ListSource source(queue);
  for (int i = 0; i < kRuns; ++i)
    source.add("small", 10, [&](auto&) {
      if (++of_source == kRuns) all_ran.set();
    });
  busy.release.set();
  while (of_source < 64) std::this_thread::yield();
  for (int i = 0; i < 20; ++i) queue.wake();
  EXPECT_LT(of_source, 100);
  EXPECT_FALSE(large_ran.happened());
  reserved.reset();
  queue.memory_released();
  EXPECT_TRUE(large_ran.wait());
  EXPECT_TRUE(all_ran.wait());
}

TEST(RunsOfASource, AreNobodysShareWithoutAClient) {
  Event all_run;
  std::atomic<int> running{0};
  MemoryBudget budget({}, [] {});
  RunQueue queue({.slots = 4, .memory = &budget, .client_share = 0.5});
  ListSource source(queue);
  for (int i = 0; i < 4; ++i)
    source.add("", 0, [&](auto&) {
      if (++running == 4) all_run.set();
      EXPECT_TRUE(all_run.wait());
    });
  EXPECT_TRUE(all_run.wait());
}

TEST(RunsOfASource, MayHaveALightSlotOnlyIfTheyAreLight) {
  Event ran;
  Busy busy;
  MemoryBudget budget({}, [] {});
  RunQueue queue({.light_slots = 1, .capacity = 10, .max_light_estimate = 10, .memory = &budget});
  ListSource source(queue);
  Event heavy_runs;
  source.add("a", 1000, [&](RunQueue::Slot& slot) {
    EXPECT_EQ(slot.priority(), RunQueue::PriorityClass::kHeavy);
    EXPECT_FALSE(slot.is_light());
    heavy_runs.set();
    EXPECT_TRUE(busy.release.wait());
  });
  ASSERT_TRUE(heavy_runs.wait());
  Event second_ran;
  source.add("a", 1000, [&](auto&) { second_ran.set(); });
  source.add("a", 10, [&](RunQueue::Slot& slot) {
    EXPECT_EQ(slot.priority(), RunQueue::PriorityClass::kLight);
    EXPECT_TRUE(slot.is_light());
    ran.set();
  });
  EXPECT_TRUE(ran.wait());
  EXPECT_FALSE(second_ran.happened());
  busy.release.set();
  EXPECT_TRUE(second_ran.wait());
}

TEST(RunsOfASource, AreNotAdmittedIfTheMemoryIsGone) {
  MemoryBudget budget({.capacity = 100}, [] {});
  RunQueue queue({.memory = &budget});
  struct Late final : RunQueue::Source {
    explicit Late(MemoryBudget& budget) : budget(budget) {}
    void run_next(RunQueue::Slot& slot) noexcept override {
      EXPECT_GE(slot.max_estimate(), 60u);
      const auto other = budget.reserve({.estimate = 50});
      EXPECT_FALSE(slot.admit({"a", 60}));
      EXPECT_TRUE(slot.admit({"a", 50}));
      asked.set();
    }
    MemoryBudget& budget;
    Event asked;
  } source(budget);
  queue.attach(source);
  queue.wake();
  EXPECT_TRUE(source.asked.wait());
  queue.detach();
  EXPECT_EQ(budget.reserved(), 0u);
}

// Otherwise each mesh of a call would be a question to the database.
TEST(RunsOfASource, AreAskedForOnlyIfThereMayBeOne) {
  MemoryBudget budget({}, [] {});
  RunQueue queue({.capacity = 100, .memory = &budget});
  ListSource source(queue);
  Event source_ran;
  source.add("a", 0, [&](auto&) { source_ran.set(); });
  ASSERT_TRUE(source_ran.wait());
  while (source.asked() < 2) std::this_thread::yield();  // there was one, so there may be another
  std::atomic<int> left{50};
  Event done;
  for (int i = 0; i < 50; ++i)
    ASSERT_TRUE(pushed(queue, plain([&] {
                         if (--left == 0) done.set();
                       }),
                       "a"));
  ASSERT_TRUE(done.wait());
  EXPECT_EQ(source.asked(), 2);
}

TEST(RunsOfASource, HaveEndedOnceItIsDetached) {
  std::atomic<bool> ended{false};
  MemoryBudget budget({}, [] {});
  RunQueue queue({.memory = &budget});
  std::optional<ListSource> source(queue);
  Event runs;
  Event release;
  source->add("a", 0, [&](auto&) {
    runs.set();
    EXPECT_TRUE(release.wait());
    ended = true;
  });
  ASSERT_TRUE(runs.wait());
  std::thread later([&] { release.set(); });
  source.reset();
  EXPECT_TRUE(ended);
  later.join();
}

}  // namespace
}  // namespace weft::server
