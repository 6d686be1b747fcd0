// SPDX-License-Identifier: Apache-2.0
#include "server/run/run_queue.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>

#include "tests/server/run/runs.h"
#include "tests/support/event.h"

namespace weft::server {
namespace {

// What the queue says of an item that does nothing; empty: it takes it.
std::string refusal(RunQueue& queue, const char* client) {
  const auto failure = queue.push({.client = client}, plain([] {}));
  EXPECT_TRUE(!failure || failure->reason == Reason::kQueueFull);
  return failure ? failure->message : "";
}

TEST(RunQueue, RunsAsManyJobsAtOnceAsItHasSlots) {
  Event first_runs;
  Event second_runs;
  RunQueue queue({.slots = 2});
  ASSERT_TRUE(pushed(queue, plain([&] {
                       first_runs.set();
                       EXPECT_TRUE(second_runs.wait());
                     })));
  ASSERT_TRUE(pushed(queue, plain([&] {
                       second_runs.set();
                       EXPECT_TRUE(first_runs.wait());
                     })));
  EXPECT_TRUE(first_runs.wait());
  EXPECT_TRUE(second_runs.wait());
}

TEST(RunQueue, RefusesWhatIsOverItsCapacity) {
  Event runs;
  Event release;
  RunQueue queue({.slots = 1, .capacity = 1});
  ASSERT_TRUE(pushed(queue, plain([&] {
                       runs.set();
                       EXPECT_TRUE(release.wait());
                     })));
  ASSERT_TRUE(runs.wait());
  EXPECT_TRUE(pushed(queue, plain([] {})));
  EXPECT_FALSE(pushed(queue, plain([] {})));
  release.set();
}

TEST(RunQueue, RemovesARunThatHasNotBegunAndNoOther) {
  Event runs;
  Event release;
  RunQueue queue({.slots = 1, .capacity = 1});
  const int working = 0;
  const int waiting = 0;
  ASSERT_FALSE(queue.push({.owner = &working}, plain([&] {
                            runs.set();
                            EXPECT_TRUE(release.wait());
                          })));
  ASSERT_TRUE(runs.wait());
  ASSERT_FALSE(queue.push({.owner = &waiting}, plain([] { ADD_FAILURE() << "it was removed"; })));
  EXPECT_FALSE(queue.remove(&working));
  EXPECT_TRUE(queue.remove(&waiting));
  EXPECT_FALSE(queue.remove(&waiting));
  release.set();
}

TEST(RunQueue, GivesTheSlotOfAJobThatPausesToAnother) {
  Event pauses;
  Event other_ran;
  Event ended;
  RunQueue queue({.slots = 1, .capacity = 8});
  ASSERT_TRUE(pushed(queue, [&](RunQueue::Slot& slot) {
    {
      const RunQueue::Pause pause(slot);
      pauses.set();
      EXPECT_TRUE(other_ran.wait());
      EXPECT_EQ(queue.stats().pausing, 1u);
    }
    EXPECT_EQ(queue.stats().pausing, 0u);
    while (queue.stats().running > 1) std::this_thread::yield();  // the other one is about to end
    ended.set();
  }));
  ASSERT_TRUE(pauses.wait());
  ASSERT_TRUE(pushed(queue, plain([&] { EXPECT_EQ(queue.stats().running, 1u); })));
  ASSERT_TRUE(pushed(queue, plain([&] { other_ran.set(); })));
  EXPECT_TRUE(ended.wait());
}

TEST(RunQueue, RunsNoMoreThanItsSlotsOnceWhatPausedHasGoneOn) {
  constexpr int kPausing = 20;
  Event all_pause;
  Event go_on;
  std::atomic<int> pausing{0};
  std::atomic<int> running{0};
  std::atomic<int> most{0};
  std::atomic<int> left{60};
  Event done;
  RunQueue queue({.slots = 2, .capacity = 100});
  for (int i = 0; i < kPausing; ++i) {
    ASSERT_TRUE(pushed(queue, [&](RunQueue::Slot& slot) {
      const RunQueue::Pause pause(slot);
      if (++pausing == kPausing) all_pause.set();
      EXPECT_TRUE(go_on.wait());
    }));
  }
  EXPECT_TRUE(all_pause.wait());
  go_on.set();
  while (queue.stats().pausing + queue.stats().running > 0) std::this_thread::yield();
  for (int i = left; i > 0; --i) {
    ASSERT_TRUE(pushed(queue, plain([&] {
                         most = std::max(most.load(), ++running);
                         std::this_thread::yield();
                         --running;
                         if (--left == 0) done.set();
                       })));
  }
  EXPECT_TRUE(done.wait());
  EXPECT_LE(most, 2);
}

TEST(RunQueue, WaitsAtItsEndForJobsThatPause) {
  Event pauses;
  Event go_on;
  std::atomic<bool> ended{false};
  std::thread later;
  {
    RunQueue queue({.slots = 1});
    ASSERT_TRUE(pushed(queue, [&](RunQueue::Slot& slot) {
      {
        const RunQueue::Pause pause(slot);
        pauses.set();
        EXPECT_TRUE(go_on.wait());
      }
      ended = true;
    }));
    ASSERT_TRUE(pauses.wait());
    later = std::thread([&] { go_on.set(); });
  }
  EXPECT_TRUE(ended);
  later.join();
}

TEST(RunQueue, GivesTurnsRoundTheClients) {
  std::string order;
  Event done;
  Busy busy;
  RunQueue queue({.slots = 1, .capacity = 100});
  busy.occupy(queue);
  for (const char* job : {"a", "a", "a", "b", "b", "c"})
    queue.push({.client = job, .estimate = 0}, plain([&, job] {
                 order += job;
                 if (order.size() == 6) done.set();
               }));
  busy.release.set();
  ASSERT_TRUE(done.wait());
  EXPECT_EQ(order, "abcaba");
}

TEST(RunQueue, PassesOverAJobThatNoMemoryIsLeftFor) {
  MemoryBudget budget({.capacity = 100}, [] {});
  auto reserved = budget.reserve({.estimate = 50});
  Event light_ran;
  Event heavy_ran;
  RunQueue queue({.slots = 1, .capacity = 10, .memory = &budget});
  queue.push({.client = "heavy", .estimate = 60}, plain([&] { heavy_ran.set(); }));
  queue.push({.client = "light", .estimate = 10}, plain([&] { light_ran.set(); }));
  ASSERT_TRUE(light_ran.wait());
  EXPECT_EQ(queue.stats().waiting, 1);
  reserved.reset();
  queue.memory_released();
  EXPECT_TRUE(heavy_ran.wait());
}

TEST(RunQueue, DoesNotPassOverAJobForEver) {
  MemoryBudget budget({.capacity = 100}, [] {});
  auto reserved = budget.reserve({.estimate = 50});
  std::atomic<int> light_runs{0};
  Event heavy_ran;
  Busy busy;
  RunQueue queue({.slots = 1, .capacity = 1000, .memory = &budget});
  busy.occupy(queue);
  queue.push({.client = "heavy", .estimate = 60}, plain([&] { heavy_ran.set(); }));
  for (int i = 0; i < 500; ++i)
    queue.push({.client = "light", .estimate = 10}, plain([&] { ++light_runs; }));
  busy.release.set();
  while (light_runs < 60) std::this_thread::yield();
  queue.memory_released();
  EXPECT_LT(light_runs, 200);
  reserved.reset();
  queue.memory_released();
  EXPECT_TRUE(heavy_ran.wait());
}

TEST(RunQueue, RefusesWhatCanNeverBegin) {
  MemoryBudget budget({.capacity = 100}, [] {});
  const auto input = budget.reserve({.estimate = 60, .purpose = MemoryBudget::Purpose::kInput});
  Event ran;
  RunQueue queue({.slots = 1, .capacity = 10, .memory = &budget});
  const auto refused = queue.push({.least = 41, .input = 60}, plain([] { FAIL() << "it ran"; }));
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->reason, Reason::kLimitExceeded);
  EXPECT_NE(refused->message.find("41"), std::string::npos) << refused->message;
  EXPECT_EQ(queue.stats().waiting, 0);
  EXPECT_FALSE(queue.push({.estimate = 1000, .least = 40, .input = 60}, plain([&] { ran.set(); })));
  EXPECT_TRUE(ran.wait());
}

TEST(RunQueue, PassesOverAJobForALaterOneOfTheSameClient) {
  MemoryBudget budget({.capacity = 100}, [] {});
  auto reserved = budget.reserve({.estimate = 50});
  Event small_ran;
  Event large_ran;
  RunQueue queue({.slots = 1, .capacity = 10, .memory = &budget});
  queue.push({.client = "a", .estimate = 60}, plain([&] { large_ran.set(); }));
  queue.push({.client = "a", .estimate = 10}, plain([&] { small_ran.set(); }));
  EXPECT_TRUE(small_ran.wait());
  EXPECT_FALSE(large_ran.happened());
  reserved.reset();
  queue.memory_released();
  EXPECT_TRUE(large_ran.wait());
}

// The queue is looked through whenever memory is released, whether a run begins then or not.
TEST(RunQueue, CountsRunsThatBeginAndNotHowOftenItLooks) {
  MemoryBudget budget({.capacity = 100}, [] {});
  auto reserved = budget.reserve({.estimate = 50});
  Busy busy;
  Event small_ran;
  RunQueue queue({.slots = 2, .capacity = 10, .memory = &budget});
  busy.occupy(queue, "other");
  queue.push({.client = "large", .estimate = 60}, plain([] {}));
  for (int i = 0; i < 500; ++i) {
    queue.memory_released();
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  queue.push({.client = "small", .estimate = 10}, plain([&] { small_ran.set(); }));
  EXPECT_TRUE(small_ran.wait());
  busy.release.set();
  reserved.reset();
  queue.memory_released();
}

TEST(RunQueue, LetsNobodyWaitForOneWhoseClientHasItsShareOfTheMemory) {
  MemoryBudget budget({.capacity = 100, .max_per_client = 40}, [] {});
  const auto unread = budget.reserve(
      {.estimate = 40, .client = "reader", .purpose = MemoryBudget::Purpose::kOutput});
  std::atomic<int> ran{0};
  Event all_ran;
  RunQueue queue({.slots = 1, .capacity = 1000, .memory = &budget});
  queue.push({.client = "reader", .estimate = 10}, plain([] { FAIL() << "it ran"; }));
  for (int i = 0; i < 200; ++i)
    queue.push({.client = "other", .estimate = 10}, plain([&] {
                 if (++ran == 200) all_ran.set();
               }));
  EXPECT_TRUE(all_ran.wait()) << ran << " ran";
}

TEST(RunQueue, HasASlotForLightJobsWhileHeavyOnesWait) {
  Event ran;
  Busy busy;
  RunQueue queue({.slots = 1, .light_slots = 1, .capacity = 10, .max_light_estimate = 10});
  busy.occupy(queue, "a", 1000);
  queue.push({.client = "a", .estimate = 1000}, plain([] {}));
  queue.push({.client = "a", .estimate = 10}, plain([&] { ran.set(); }));
  EXPECT_TRUE(ran.wait());
  EXPECT_EQ(queue.stats().waiting, 1);
  busy.release.set();
}

TEST(RunQueue, LetsOneClientHaveItsShareOfWhatMayWait) {
  Busy busy;
  RunQueue queue({.slots = 1, .capacity = 4, .client_share = 0.5});
  busy.occupy(queue);
  EXPECT_TRUE(pushed(queue, plain([] {}), "a"));
  EXPECT_TRUE(pushed(queue, plain([] {}), "a"));
  EXPECT_EQ(refusal(queue, "a"),
            "2 calls of yours wait already; this server's limit for one client is 2");
  EXPECT_TRUE(pushed(queue, plain([] {}), "b"));
  EXPECT_TRUE(pushed(queue, plain([] {}), "c"));
  EXPECT_EQ(refusal(queue, "c"), "4 calls wait already; this server's limit is 4");
  busy.release.set();
}

TEST(RunQueue, HasRoomForAClientOfWhomNothingWaitsUpToTwiceTheCapacity) {
  Busy busy;
  RunQueue queue({.slots = 1, .capacity = 4, .client_share = 0.75});
  busy.occupy(queue);
  for (const char* client : {"a", "a", "b", "b"}) EXPECT_EQ(refusal(queue, client), "");
  EXPECT_NE(refusal(queue, "a"), "");
  for (const char* client : {"c", "d", "e", "f"}) {
    EXPECT_EQ(refusal(queue, client), "");
    EXPECT_NE(refusal(queue, client), "");
  }
  EXPECT_NE(refusal(queue, "g"), "");
  busy.release.set();
}

TEST(RunQueue, LetsOneClientHaveItsShareOfTheSlots) {
  Event other_ran;
  Event release;
  std::atomic<int> running{0};
  RunQueue queue({.slots = 4, .capacity = 40, .client_share = 0.75});
  for (int i = 0; i < 8; ++i)
    ASSERT_TRUE(pushed(queue, plain([&] {
                         EXPECT_LE(++running, 3);
                         EXPECT_TRUE(release.wait());
                         --running;
                       }),
                       "a"));
  while (running < 3) std::this_thread::yield();
  ASSERT_TRUE(pushed(queue, plain([&] { other_ran.set(); }), "b"));
  EXPECT_TRUE(other_ran.wait());
  release.set();
  while (queue.stats().waiting + queue.stats().running > 0) std::this_thread::yield();
}

}  // namespace
}  // namespace weft::server
