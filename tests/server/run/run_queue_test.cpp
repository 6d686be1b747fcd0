// SPDX-License-Identifier: Apache-2.0
#include "server/run/run_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/event.h"

namespace weft::server {
namespace {

class Task final : public RunQueue::Item {
 public:
  explicit Task(std::function<void(RunQueue::Slot&)> work) : work_(std::move(work)) {}
  void run(RunQueue::Slot& slot) noexcept override { work_(slot); }

 private:
  std::function<void(RunQueue::Slot&)> work_;
};

std::shared_ptr<Task> make_task(std::function<void()> work) {
  return std::make_shared<Task>([work = std::move(work)](RunQueue::Slot&) { work(); });
}
std::shared_ptr<Task> make_slotted(std::function<void(RunQueue::Slot&)> work) {
  return std::make_shared<Task>(std::move(work));
}
bool pushed(RunQueue& queue, std::shared_ptr<Task> task, const char* client,
            std::uint64_t estimate = 0) {
  return !queue.push(std::move(task), {.client = client, .estimate = estimate});
}
bool pushed(RunQueue& queue, std::shared_ptr<Task> task) {
  return pushed(queue, std::move(task), "");
}
// What the queue says of an item that does nothing; empty: it takes it.
std::string refusal(RunQueue& queue, const char* client) {
  const auto failure = queue.push(make_task([] {}), {.client = client});
  EXPECT_TRUE(!failure || failure->reason == Reason::kQueueFull);
  return failure ? failure->message : "";
}
const auto kNever = [] { return false; };

TEST(RunQueue, RunsAsManyJobsAtOnceAsItHasSlots) {
  Event first_runs;
  Event second_runs;
  RunQueue queue({.slots = 2});
  ASSERT_TRUE(pushed(queue, make_task([&] {
                       first_runs.set();
                       EXPECT_TRUE(second_runs.wait());
                     })));
  ASSERT_TRUE(pushed(queue, make_task([&] {
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
  ASSERT_TRUE(pushed(queue, make_task([&] {
                       runs.set();
                       EXPECT_TRUE(release.wait());
                     })));
  ASSERT_TRUE(runs.wait());
  EXPECT_TRUE(pushed(queue, make_task([] {})));
  EXPECT_FALSE(pushed(queue, make_task([] {})));
  release.set();
}

TEST(RunQueue, GivesBackAJobThatHasNotBegunAndNoOther) {
  Event runs;
  Event release;
  RunQueue queue({.slots = 1, .capacity = 1});
  const auto working = make_task([&] {
    runs.set();
    EXPECT_TRUE(release.wait());
  });
  const auto waiting = make_task([] { ADD_FAILURE() << "it was taken out"; });
  ASSERT_TRUE(pushed(queue, working));
  ASSERT_TRUE(runs.wait());
  ASSERT_TRUE(pushed(queue, waiting));
  EXPECT_FALSE(queue.remove(*working));
  EXPECT_TRUE(queue.remove(*waiting));
  EXPECT_FALSE(queue.remove(*waiting));
  release.set();
}

TEST(RunQueue, GivesTheSlotOfAJobThatPausesToAnother) {
  Event pauses;
  Event other_ran;
  Event ended;
  RunQueue queue({.slots = 1, .capacity = 8});
  ASSERT_TRUE(pushed(queue, make_slotted([&](RunQueue::Slot& slot) {
                       {
                         const RunQueue::Pause pause(slot);
                         pauses.set();
                         EXPECT_TRUE(other_ran.wait());
                         EXPECT_EQ(queue.figures().pausing, 1u);
                       }
                       EXPECT_EQ(queue.figures().pausing, 0u);
                       while (queue.figures().running > 1)
                         std::this_thread::yield();  // the other one is about to end
                       ended.set();
                     })));
  ASSERT_TRUE(pauses.wait());
  ASSERT_TRUE(pushed(queue, make_task([&] { EXPECT_EQ(queue.figures().running, 1u); })));
  ASSERT_TRUE(pushed(queue, make_task([&] { other_ran.set(); })));
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
    ASSERT_TRUE(pushed(queue, make_slotted([&](RunQueue::Slot& slot) {
                         const RunQueue::Pause pause(slot);
                         if (++pausing == kPausing) all_pause.set();
                         EXPECT_TRUE(go_on.wait());
                       })));
  }
  EXPECT_TRUE(all_pause.wait());
  go_on.set();
  while (queue.figures().pausing + queue.figures().running > 0) std::this_thread::yield();
  for (int i = left; i > 0; --i) {
    ASSERT_TRUE(pushed(queue, make_task([&] {
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
    ASSERT_TRUE(pushed(queue, make_slotted([&](RunQueue::Slot& slot) {
                         {
                           const RunQueue::Pause pause(slot);
                           pauses.set();
                           EXPECT_TRUE(go_on.wait());
                         }
                         ended = true;
                       })));
    ASSERT_TRUE(pauses.wait());
    later = std::thread([&] { go_on.set(); });
  }
  EXPECT_TRUE(ended);
  later.join();
}

// A slot that is busy until `release`, so that what is pushed meanwhile waits.
struct Busy {
  Event runs;
  Event release;
  void occupy(RunQueue& queue) {
    ASSERT_TRUE(pushed(queue, make_task([this] {
                         runs.set();
                         EXPECT_TRUE(release.wait());
                       })));
    ASSERT_TRUE(runs.wait());
  }
};

TEST(RunQueue, GivesTurnsRoundTheClients) {
  std::string order;
  Event done;
  Busy busy;
  RunQueue queue({.slots = 1, .capacity = 100});
  busy.occupy(queue);
  for (const char* job : {"a", "a", "a", "b", "b", "c"})
    queue.push(make_task([&, job] {
                 order += job;
                 if (order.size() == 6) done.set();
               }),
               {.client = job, .estimate = 0});
  busy.release.set();
  ASSERT_TRUE(done.wait());
  EXPECT_EQ(order, "abcaba");
}

TEST(RunQueue, PassesOverAJobThatNoMemoryIsLeftFor) {
  MemoryGate gate({.capacity = 100}, [] {});
  auto taken = gate.take({.estimate = 50});
  Event light_ran;
  Event heavy_ran;
  RunQueue queue({.slots = 1, .capacity = 10, .gate = &gate});
  queue.push(make_task([&] { heavy_ran.set(); }), {.client = "heavy", .estimate = 60});
  queue.push(make_task([&] { light_ran.set(); }), {.client = "light", .estimate = 10});
  ASSERT_TRUE(light_ran.wait());
  EXPECT_EQ(queue.figures().waiting, 1);
  taken.reset();
  queue.notify();
  EXPECT_TRUE(heavy_ran.wait());
}

TEST(RunQueue, DoesNotPassOverAJobForEver) {
  MemoryGate gate({.capacity = 100}, [] {});
  auto taken = gate.take({.estimate = 50});
  std::atomic<int> light_runs{0};
  Event heavy_ran;
  Busy busy;
  RunQueue queue({.slots = 1, .capacity = 1000, .gate = &gate});
  busy.occupy(queue);
  queue.push(make_task([&] { heavy_ran.set(); }), {.client = "heavy", .estimate = 60});
  for (int i = 0; i < 500; ++i)
    queue.push(make_task([&] { ++light_runs; }), {.client = "light", .estimate = 10});
  busy.release.set();
  while (light_runs < 60) std::this_thread::yield();
  queue.notify();
  EXPECT_LT(light_runs, 200);
  taken.reset();
  queue.notify();
  EXPECT_TRUE(heavy_ran.wait());
}

TEST(RunQueue, HasASlotForLightJobsWhileHeavyOnesWait) {
  Event ran;
  Busy busy;
  RunQueue queue({.slots = 1, .light_slots = 1, .capacity = 10, .light = 10});
  Event heavy_runs;
  queue.push(make_task([&] {
               heavy_runs.set();
               EXPECT_TRUE(busy.release.wait());
             }),
             {.client = "a", .estimate = 1000});
  ASSERT_TRUE(heavy_runs.wait());
  queue.push(make_task([] {}), {.client = "a", .estimate = 1000});
  queue.push(make_task([&] { ran.set(); }), {.client = "a", .estimate = 10});
  EXPECT_TRUE(ran.wait());
  EXPECT_EQ(queue.figures().waiting, 1);
  busy.release.set();
}

TEST(RunQueue, LetsOneClientHaveItsShareOfWhatMayWait) {
  Busy busy;
  RunQueue queue({.slots = 1, .capacity = 4, .client_share = 0.5});
  busy.occupy(queue);
  EXPECT_TRUE(pushed(queue, make_task([] {}), "a"));
  EXPECT_TRUE(pushed(queue, make_task([] {}), "a"));
  EXPECT_EQ(refusal(queue, "a"),
            "2 calls of yours wait already; this server's limit for one client is 2");
  EXPECT_TRUE(pushed(queue, make_task([] {}), "b"));
  EXPECT_TRUE(pushed(queue, make_task([] {}), "c"));
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
    ASSERT_TRUE(pushed(queue, make_task([&] {
                         EXPECT_LE(++running, 3);
                         EXPECT_TRUE(release.wait());
                         --running;
                       }),
                       "a"));
  while (running < 3) std::this_thread::yield();
  ASSERT_TRUE(pushed(queue, make_task([&] { other_ran.set(); }), "b"));
  EXPECT_TRUE(other_ran.wait());
  release.set();
  while (queue.figures().waiting + queue.figures().running > 0) std::this_thread::yield();
}

TEST(RunQueue, GivesTheLightSlotOfAHeavyItemToAnotherAndWaitsForAHeavyOne) {
  Event light_ran;
  Event moves;
  Event moved;
  std::atomic<bool> has_moved{false};
  Busy busy;
  RunQueue queue({.slots = 1, .light_slots = 1, .capacity = 10, .light = 10});
  Event heavy_runs;
  ASSERT_TRUE(pushed(queue, make_task([&] {
                       heavy_runs.set();
                       EXPECT_TRUE(busy.release.wait());
                     }),
                     "a", 1000));
  ASSERT_TRUE(heavy_runs.wait());
  ASSERT_TRUE(pushed(queue, make_slotted([&](RunQueue::Slot& slot) {
                       EXPECT_EQ(slot.priority(), RunQueue::Priority::kLight);
                       moves.set();
                       slot.promote(kNever);
                       EXPECT_EQ(slot.priority(), RunQueue::Priority::kHeavy);
                       has_moved = true;
                       moved.set();
                     }),
                     "b", 10));
  ASSERT_TRUE(moves.wait());
  ASSERT_TRUE(pushed(queue, make_task([&] { light_ran.set(); }), "c", 10));
  EXPECT_TRUE(light_ran.wait());
  EXPECT_FALSE(has_moved);
  EXPECT_EQ(queue.figures().waiting, 1u);
  EXPECT_EQ(queue.figures().pausing, 0u);
  busy.release.set();
  EXPECT_TRUE(moved.wait());
}

TEST(RunQueue, LetsAnItemThatIsPromotedGoOnOnceItIsStopped) {
  Event ended;
  Event moves;
  std::atomic<bool> stopped{false};
  Busy busy;
  RunQueue queue({.slots = 1, .light_slots = 1, .capacity = 10, .light = 10});
  Event heavy_runs;
  ASSERT_TRUE(pushed(queue, make_task([&] {
                       heavy_runs.set();
                       EXPECT_TRUE(busy.release.wait());
                     }),
                     "a", 1000));
  ASSERT_TRUE(heavy_runs.wait());
  ASSERT_TRUE(pushed(queue, make_slotted([&](RunQueue::Slot& slot) {
                       moves.set();
                       slot.promote([&] { return stopped.load(); });
                       ended.set();
                     }),
                     "b", 10));
  ASSERT_TRUE(moves.wait());
  stopped = true;
  EXPECT_TRUE(ended.wait());
  busy.release.set();
}

// The heavy slot is busy, so that only the light one is left.
class DistrustInTheQueue : public testing::TestWithParam<double> {
 protected:
  DistrustInTheQueue() {
    Event runs;
    EXPECT_TRUE(pushed(queue_, make_task([&] {
                         runs.set();
                         EXPECT_TRUE(busy_.release.wait());
                       }),
                       "a", 1000));
    EXPECT_TRUE(runs.wait());
  }
  void turn_out_heavy(const char* client) {
    Event moves;
    EXPECT_TRUE(pushed(queue_, make_slotted([&](RunQueue::Slot& slot) {
                         slot.promote([&] {
                           moves.set();
                           return true;
                         });
                       }),
                       client, 10));
    EXPECT_TRUE(moves.wait());
    // It waits for the other slot until it has seen that it is to stop.
    while (queue_.figures().running > 1 || queue_.figures().waiting > 0) std::this_thread::yield();
  }

  Busy busy_;
  RunQueue queue_{
      {.slots = 1, .light_slots = 1, .capacity = 10, .light = 10, .client_share = GetParam()}};
};

INSTANTIATE_TEST_SUITE_P(OfClients, DistrustInTheQueue, testing::Values(0.75, 1.0));

TEST_P(DistrustInTheQueue,
       KeepsTheLightSlotFromAClientWhoseItemTurnedOutHeavyIfClientsAreToldApart) {
  turn_out_heavy("b");
  Event of_b;
  Event of_c;
  ASSERT_TRUE(pushed(queue_, make_task([&] { of_b.set(); }), "b", 10));
  ASSERT_TRUE(pushed(queue_, make_task([&] { of_c.set(); }), "c", 10));
  EXPECT_TRUE(of_c.wait());
  if (GetParam() < 1) {
    EXPECT_EQ(queue_.figures().waiting, 1u) << "b is for the heavy slot";
  } else {
    EXPECT_TRUE(of_b.wait());
  }
  busy_.release.set();
  EXPECT_TRUE(of_b.wait());
}

TEST(RunQueue, TrustsAClientAgainAfterAWhile) {
  Busy busy;
  RunQueue queue({.slots = 1,
                  .light_slots = 1,
                  .capacity = 10,
                  .light = 10,
                  .client_share = 0.75,
                  .distrust = std::chrono::milliseconds(1)});
  Event runs;
  ASSERT_TRUE(pushed(queue, make_task([&] {
                       runs.set();
                       EXPECT_TRUE(busy.release.wait());
                     }),
                     "a", 1000));
  ASSERT_TRUE(runs.wait());
  Event ended;
  ASSERT_TRUE(pushed(queue, make_slotted([&](RunQueue::Slot& slot) {
                       slot.promote([] { return true; });
                       ended.set();
                     }),
                     "b", 10));
  ASSERT_TRUE(ended.wait());
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  Event again;
  ASSERT_TRUE(pushed(queue, make_task([&] { again.set(); }), "b", 10));
  EXPECT_TRUE(again.wait());
  busy.release.set();
}

// At the end there are as many slots as in the beginning.
TEST(RunQueue, HasAllSlotsAgainAfterManyItemsWerePromoted) {
  constexpr int kMoving = 40;
  std::atomic<int> moved{0};
  std::atomic<int> running{0};
  RunQueue queue({.slots = 2, .light_slots = 2, .capacity = 100, .light = 10});
  for (int i = 0; i < kMoving; ++i)
    ASSERT_TRUE(pushed(queue, make_slotted([&](RunQueue::Slot& slot) {
                         slot.promote(kNever);
                         EXPECT_LE(++running, 2);
                         std::this_thread::yield();
                         --running;
                         ++moved;
                       }),
                       "a", 10));
  while (moved < kMoving || queue.figures().running > 0) std::this_thread::yield();
  EXPECT_EQ(queue.figures().waiting, 0u);
  EXPECT_EQ(queue.figures().pausing, 0u);
  Event all_run;
  std::atomic<int> at_once{0};
  for (int i = 0; i < 4; ++i)
    ASSERT_TRUE(pushed(queue, make_task([&] {
                         if (++at_once == 4) all_run.set();
                         EXPECT_TRUE(all_run.wait());
                       }),
                       "a", 10));
  EXPECT_TRUE(all_run.wait());
}

// Runs that wait in a list, the first first.
class ListSource final : public RunQueue::Source {
 public:
  using Work = std::function<void(RunQueue::Slot&)>;

  explicit ListSource(RunQueue& queue) : queue_(queue) { queue_.attach(*this); }
  ~ListSource() override { queue_.detach(); }

  void add(const char* client, std::uint64_t estimate, Work work) {
    {
      std::lock_guard lock(mutex_);
      runs_.push_back({{client, estimate}, std::move(work)});
    }
    queue_.wake();
  }

  void run_next(RunQueue::Slot& slot) noexcept override {
    const std::vector<std::string> full = slot.full_clients();
    std::unique_lock lock(mutex_);
    ++asked_;
    const auto found = std::ranges::find_if(runs_, [&](const auto& run) {
      return run.first.estimate <= slot.room() &&
             std::ranges::find(full, run.first.client) == full.end();
    });
    if (found == runs_.end()) return;
    if (!slot.admit(found->first)) return;
    const Work work = std::move(found->second);
    runs_.erase(found);
    lock.unlock();
    work(slot);
  }

  int asked() const { return asked_; }

 private:
  RunQueue& queue_;
  std::mutex mutex_;
  std::vector<std::pair<RunQueue::Ticket, Work>> runs_;
  std::atomic<int> asked_{0};
};

TEST(RunsOfASource, HaveTheSlotsInTurnsWithThoseThatWaitHere) {
  std::string order;
  Event done;
  Busy busy;
  MemoryGate gate({}, [] {});
  RunQueue queue({.capacity = 100, .gate = &gate});
  ListSource source(queue);
  busy.occupy(queue);
  const auto ran = [&](char what) {
    order += what;
    if (order.size() == 7) done.set();
  };
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(pushed(queue, make_task([&] { ran('c'); }), i == 0 ? "a" : "b"));
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
  MemoryGate gate({}, [] {});
  RunQueue queue({.slots = 2, .capacity = 100, .gate = &gate});
  ListSource source(queue);
  const auto run = [&](auto&) {
    EXPECT_LE(++running, 2);
    std::this_thread::yield();
    --running;
    if (--left == 0) done.set();
  };
  for (int i = 0; i < kRuns; ++i) {
    ASSERT_TRUE(pushed(queue, make_slotted(run), "a"));
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
  MemoryGate gate({}, [] {});
  RunQueue queue({.slots = 4, .capacity = 100, .gate = &gate, .client_share = 0.5});
  ListSource source(queue);
  const auto run = [&](Event& may_end) {
    if (++running == 2) both_run.set();
    EXPECT_TRUE(may_end.wait());
  };
  ASSERT_TRUE(pushed(queue, make_task([&] { run(one_may_end); }), "a"));
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

TEST(RunsOfASource, AreNobodysShareWithoutAClient) {
  Event all_run;
  std::atomic<int> running{0};
  MemoryGate gate({}, [] {});
  RunQueue queue({.slots = 4, .gate = &gate, .client_share = 0.5});
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
  MemoryGate gate({}, [] {});
  RunQueue queue({.light_slots = 1, .capacity = 10, .light = 10, .gate = &gate});
  ListSource source(queue);
  Event heavy_runs;
  source.add("a", 1000, [&](RunQueue::Slot& slot) {
    EXPECT_EQ(slot.priority(), RunQueue::Priority::kHeavy);
    EXPECT_FALSE(slot.is_light());
    heavy_runs.set();
    EXPECT_TRUE(busy.release.wait());
  });
  ASSERT_TRUE(heavy_runs.wait());
  Event second_ran;
  source.add("a", 1000, [&](auto&) { second_ran.set(); });
  source.add("a", 10, [&](RunQueue::Slot& slot) {
    EXPECT_EQ(slot.priority(), RunQueue::Priority::kLight);
    EXPECT_TRUE(slot.is_light());
    ran.set();
  });
  EXPECT_TRUE(ran.wait());
  EXPECT_FALSE(second_ran.happened());
  busy.release.set();
  EXPECT_TRUE(second_ran.wait());
}

TEST(RunsOfASource, AreNotAdmittedIfTheMemoryIsGone) {
  MemoryGate gate({.capacity = 100}, [] {});
  RunQueue queue({.gate = &gate});
  struct Late final : RunQueue::Source {
    explicit Late(MemoryGate& gate) : gate(gate) {}
    void run_next(RunQueue::Slot& slot) noexcept override {
      EXPECT_GE(slot.room(), 60u);
      const auto other = gate.take({.estimate = 50});
      EXPECT_FALSE(slot.admit({"a", 60}));
      EXPECT_TRUE(slot.admit({"a", 50}));
      asked.set();
    }
    MemoryGate& gate;
    Event asked;
  } source(gate);
  queue.attach(source);
  queue.wake();
  EXPECT_TRUE(source.asked.wait());
  queue.detach();
  EXPECT_EQ(gate.taken(), 0u);
}

// Otherwise each mesh of a call would be a question to the database.
TEST(RunsOfASource, AreAskedForOnlyIfThereMayBeOne) {
  MemoryGate gate({}, [] {});
  RunQueue queue({.capacity = 100, .gate = &gate});
  ListSource source(queue);
  Event source_ran;
  source.add("a", 0, [&](auto&) { source_ran.set(); });
  ASSERT_TRUE(source_ran.wait());
  while (source.asked() < 2) std::this_thread::yield();  // there was one, so there may be another
  std::atomic<int> left{50};
  Event done;
  for (int i = 0; i < 50; ++i)
    ASSERT_TRUE(pushed(queue, make_task([&] {
                         if (--left == 0) done.set();
                       }),
                       "a"));
  ASSERT_TRUE(done.wait());
  EXPECT_EQ(source.asked(), 2);
}

TEST(RunsOfASource, HaveEndedOnceItIsDetached) {
  std::atomic<bool> ended{false};
  MemoryGate gate({}, [] {});
  RunQueue queue({.gate = &gate});
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

// One run waits for memory in the only heavy slot, another one has it and waits for that slot:
// unless one of them ends, both wait for ever.
class Promotion : public testing::TestWithParam<bool> {};

TEST_P(Promotion, OfARunThatHasTheMemoryOfTheOneInTheSlotEndsThat) {
  const bool from_source = GetParam();
  MemoryGate gate({.capacity = 100}, [] {});
  RunQueue queue({.light_slots = 1, .capacity = 10, .light = 60, .gate = &gate});
  ListSource source(queue);
  const auto begin = [&](std::uint64_t estimate, const ListSource::Work& work) {
    if (from_source)
      source.add("a", estimate, work);
    else
      ASSERT_TRUE(pushed(queue, make_slotted(work), "a", estimate));
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
    EXPECT_EQ(slot.priority(), RunQueue::Priority::kHeavy);
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
