// SPDX-License-Identifier: Apache-2.0
// Runs that begin in a light slot of a RunQueue and turn out heavy.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "server/run/memory_budget.h"
#include "server/run/run_queue.h"
#include "tests/server/run/runs.h"
#include "tests/support/event.h"

namespace weft::server {
namespace {

const auto kNever = [] { return false; };

// The heavy slot is busy, so that only the light one is left.
class PromotedRunThatWaits : public testing::Test {
 protected:
  void SetUp() override { busy_.occupy(queue_, "a", 1000); }
  // Pushes a run that is promoted; returns when it is about to wait for the heavy slot.
  void promote(const std::function<bool()>& stopped, std::function<void(RunQueue::Slot&)> then) {
    const auto run = [this, stopped, then = std::move(then)](RunQueue::Slot& slot) {
      EXPECT_EQ(slot.priority(), RunQueue::PriorityClass::kLight);
      moves_.set();
      slot.promote(stopped);
      then(slot);
    };
    ASSERT_TRUE(pushed(queue_, run, "b", 10));
    ASSERT_TRUE(moves_.wait());
  }

  Event moves_;
  Event ended_;
  Busy busy_;
  RunQueue queue_{{.slots = 1, .light_slots = 1, .capacity = 10, .max_light_estimate = 10}};
};

TEST_F(PromotedRunThatWaits, GivesItsLightSlotToAnotherAndWaitsForAHeavyOne) {
  Event light_ran;
  std::atomic<bool> has_moved{false};
  promote(kNever, [&](RunQueue::Slot& slot) {
    EXPECT_EQ(slot.priority(), RunQueue::PriorityClass::kHeavy);
    has_moved = true;
    ended_.set();
  });
  ASSERT_TRUE(pushed(queue_, plain([&] { light_ran.set(); }), "c", 10));
  EXPECT_TRUE(light_ran.wait());
  EXPECT_FALSE(has_moved);
  EXPECT_EQ(queue_.stats().waiting, 1u);
  EXPECT_EQ(queue_.stats().pausing, 0u);
  busy_.release.set();
  EXPECT_TRUE(ended_.wait());
}

TEST_F(PromotedRunThatWaits, GoesOnOnceItIsStopped) {
  std::atomic<bool> stopped{false};
  promote([&] { return stopped.load(); }, [&](RunQueue::Slot&) { ended_.set(); });
  stopped = true;
  EXPECT_TRUE(ended_.wait());
  busy_.release.set();
}

// As with PromotedRunThatWaits.
class DistrustInTheQueue : public testing::TestWithParam<double> {
 protected:
  void SetUp() override { busy_.occupy(queue_, "a", 1000); }
  void turn_out_heavy(const char* client) {
    Event moves;
    EXPECT_TRUE(pushed(
        queue_,
        [&](RunQueue::Slot& slot) {
          slot.promote([&] {
            moves.set();
            return true;
          });
        },
        client, 10));
    EXPECT_TRUE(moves.wait());
    // It waits for the other slot until it has seen that it is to stop.
    while (queue_.stats().running > 1 || queue_.stats().waiting > 0) std::this_thread::yield();
  }

  Busy busy_;
  RunQueue queue_{{.slots = 1,
                   .light_slots = 1,
                   .capacity = 10,
                   .max_light_estimate = 10,
                   .client_share = GetParam()}};
};

INSTANTIATE_TEST_SUITE_P(OfClients, DistrustInTheQueue, testing::Values(0.75, 1.0));

TEST_P(DistrustInTheQueue,
       KeepsTheLightSlotFromAClientWhoseItemTurnedOutHeavyIfClientsAreToldApart) {
  turn_out_heavy("b");
  Event of_b;
  Event of_c;
  ASSERT_TRUE(pushed(queue_, plain([&] { of_b.set(); }), "b", 10));
  ASSERT_TRUE(pushed(queue_, plain([&] { of_c.set(); }), "c", 10));
  EXPECT_TRUE(of_c.wait());
  if (GetParam() < 1) {
    EXPECT_EQ(queue_.stats().waiting, 1u) << "b is for the heavy slot";
  } else {
    EXPECT_TRUE(of_b.wait());
  }
  busy_.release.set();
  EXPECT_TRUE(of_b.wait());
}

TEST(PromotedRun, IsForgottenAfterAWhile) {
  Busy busy;
  RunQueue queue({.slots = 1,
                  .light_slots = 1,
                  .capacity = 10,
                  .max_light_estimate = 10,
                  .client_share = 0.75,
                  .distrust = std::chrono::milliseconds(1)});
  busy.occupy(queue, "a", 1000);
  Event ended;
  ASSERT_TRUE(pushed(
      queue,
      [&](RunQueue::Slot& slot) {
        slot.promote([] { return true; });
        ended.set();
      },
      "b", 10));
  ASSERT_TRUE(ended.wait());
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  Event again;
  ASSERT_TRUE(pushed(queue, plain([&] { again.set(); }), "b", 10));
  EXPECT_TRUE(again.wait());
  busy.release.set();
}

// At the end there are as many slots as in the beginning.
TEST(PromotedRun, LeavesAllSlotsAsTheyWere) {
  constexpr int kMoving = 40;
  std::atomic<int> moved{0};
  std::atomic<int> running{0};
  Event all_run;
  std::atomic<int> at_once{0};
  RunQueue queue({.slots = 2, .light_slots = 2, .capacity = 100, .max_light_estimate = 10});
  for (int i = 0; i < kMoving; ++i)
    ASSERT_TRUE(pushed(
        queue,
        [&](RunQueue::Slot& slot) {
          slot.promote(kNever);
          EXPECT_LE(++running, 2);
          std::this_thread::yield();
          --running;
          ++moved;
        },
        "a", 10));
  while (moved < kMoving || queue.stats().running > 0) std::this_thread::yield();
  EXPECT_EQ(queue.stats().waiting, 0u);
  EXPECT_EQ(queue.stats().pausing, 0u);
  for (int i = 0; i < 4; ++i)
    ASSERT_TRUE(pushed(queue, plain([&] {
                         if (++at_once == 4) all_run.set();
                         EXPECT_TRUE(all_run.wait());
                       }),
                       "a", 10));
  EXPECT_TRUE(all_run.wait());
}

// One run waits for memory in the only heavy slot, another one has it and waits for that slot:
// unless one of them ends, both wait for ever.
class Promotion : public testing::TestWithParam<bool> {};

TEST_P(Promotion, OfARunThatHasTheMemoryOfTheOneInTheSlotEndsThat) {
  const bool from_source = GetParam();
  MemoryBudget budget({.capacity = 100}, [] {});
  RunQueue queue({.light_slots = 1, .capacity = 10, .max_light_estimate = 60, .memory = &budget});
  ListSource source(queue);
  const auto begin = [&](std::uint64_t estimate, const RunQueue::Work& work) {
    if (from_source)
      source.add("a", estimate, work);
    else
      ASSERT_TRUE(pushed(queue, work, "a", estimate));
  };
  const auto go_on = [] { return std::optional<Error>(); };
  Event light_runs;
  Event heavy_may_grow;
  Event promoted;
  begin(60, [&](RunQueue::Slot& slot) {
    light_runs.set();
    EXPECT_TRUE(heavy_may_grow.wait());
    slot.promote(kNever);
    promoted.set();
  });
  ASSERT_TRUE(light_runs.wait());
  Event ended;
  begin(40, [&](RunQueue::Slot& slot) {
    EXPECT_EQ(slot.priority(), RunQueue::PriorityClass::kHeavy);
    heavy_may_grow.set();
    const auto error = slot.memory().grow_to(80, go_on);
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code, ErrorCode::kOutOfMemory);
    ended.set();
  });
  EXPECT_TRUE(ended.wait());
  EXPECT_TRUE(promoted.wait());
}

INSTANTIATE_TEST_SUITE_P(Runs, Promotion, testing::Bool(), [](const auto& info) {
  return std::string(info.param ? "OfASource" : "ThatWaitHere");
});

}  // namespace
}  // namespace weft::server
