// SPDX-License-Identifier: Apache-2.0
#include "server/admission/work_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <thread>

#include "tests/support/event.h"

namespace weft::server {
namespace {

class Task final : public WorkQueue::Item {
 public:
  explicit Task(std::function<void(WorkQueue::Place&)> work) : work_(std::move(work)) {}
  void run(WorkQueue::Place& place) noexcept override { work_(place); }

 private:
  std::function<void(WorkQueue::Place&)> work_;
};

std::shared_ptr<Task> make_task(std::function<void()> work) {
  return std::make_shared<Task>([work = std::move(work)](WorkQueue::Place&) { work(); });
}
std::shared_ptr<Task> make_placed(std::function<void(WorkQueue::Place&)> work) {
  return std::make_shared<Task>(std::move(work));
}
bool pushed(WorkQueue& queue, std::shared_ptr<Task> task, const char* client,
            std::uint64_t estimate = 0) {
  return queue.push(std::move(task), {.client = client, .estimate = estimate}) ==
         WorkQueue::Pushed::kYes;
}
const auto kNever = [] { return false; };

TEST(WorkQueue, RunsAsManyJobsAtOnceAsItHasWorkers) {
  Event first_runs;
  Event second_runs;
  WorkQueue queue({.workers = 2});
  ASSERT_TRUE(queue.push(make_task([&] {
    first_runs.set();
    EXPECT_TRUE(second_runs.wait());
  })));
  ASSERT_TRUE(queue.push(make_task([&] {
    second_runs.set();
    EXPECT_TRUE(first_runs.wait());
  })));
  EXPECT_TRUE(first_runs.wait());
  EXPECT_TRUE(second_runs.wait());
}

TEST(WorkQueue, RefusesWhatIsOverItsCapacity) {
  Event runs;
  Event release;
  WorkQueue queue({.workers = 1, .capacity = 1});
  ASSERT_TRUE(queue.push(make_task([&] {
    runs.set();
    EXPECT_TRUE(release.wait());
  })));
  ASSERT_TRUE(runs.wait());
  EXPECT_TRUE(queue.push(make_task([] {})));
  EXPECT_FALSE(queue.push(make_task([] {})));
  release.set();
}

TEST(WorkQueue, GivesBackAJobThatHasNotBegunAndNoOther) {
  Event runs;
  Event release;
  WorkQueue queue({.workers = 1, .capacity = 1});
  const auto working = make_task([&] {
    runs.set();
    EXPECT_TRUE(release.wait());
  });
  const auto waiting = make_task([] { ADD_FAILURE() << "it was taken out"; });
  ASSERT_TRUE(queue.push(working));
  ASSERT_TRUE(runs.wait());
  ASSERT_TRUE(queue.push(waiting));
  EXPECT_FALSE(queue.remove(*working));
  EXPECT_TRUE(queue.remove(*waiting));
  EXPECT_FALSE(queue.remove(*waiting));
  release.set();
}

TEST(WorkQueue, GivesThePlaceOfAJobThatPausesToAnother) {
  Event pauses;
  Event other_ran;
  Event ended;
  WorkQueue queue({.workers = 1, .capacity = 8});
  ASSERT_TRUE(queue.push(make_placed([&](WorkQueue::Place& place) {
    {
      const WorkQueue::Pause pause(place);
      pauses.set();
      EXPECT_TRUE(other_ran.wait());
      EXPECT_EQ(queue.pausing(), 1u);
    }
    EXPECT_EQ(queue.pausing(), 0u);
    while (queue.running() > 1) std::this_thread::yield();  // the other one is about to end
    ended.set();
  })));
  ASSERT_TRUE(pauses.wait());
  ASSERT_TRUE(queue.push(make_task([&] { EXPECT_EQ(queue.running(), 1u); })));
  ASSERT_TRUE(queue.push(make_task([&] { other_ran.set(); })));
  EXPECT_TRUE(ended.wait());
}

TEST(WorkQueue, RunsNoMoreThanItsPlacesOnceWhatPausedHasGoneOn) {
  constexpr int kPausing = 20;
  Event all_pause;
  Event go_on;
  std::atomic<int> pausing{0};
  std::atomic<int> running{0};
  std::atomic<int> most{0};
  std::atomic<int> left{60};
  Event done;
  WorkQueue queue({.workers = 2, .capacity = 100});
  for (int i = 0; i < kPausing; ++i) {
    ASSERT_TRUE(queue.push(make_placed([&](WorkQueue::Place& place) {
      const WorkQueue::Pause pause(place);
      if (++pausing == kPausing) all_pause.set();
      EXPECT_TRUE(go_on.wait());
    })));
  }
  EXPECT_TRUE(all_pause.wait());
  go_on.set();
  while (queue.pausing() + queue.running() > 0) std::this_thread::yield();
  for (int i = left; i > 0; --i) {
    ASSERT_TRUE(queue.push(make_task([&] {
      most = std::max(most.load(), ++running);
      std::this_thread::yield();
      --running;
      if (--left == 0) done.set();
    })));
  }
  EXPECT_TRUE(done.wait());
  EXPECT_LE(most, 2);
}

TEST(WorkQueue, WaitsAtItsEndForJobsThatPause) {
  Event pauses;
  Event go_on;
  std::atomic<bool> ended{false};
  std::thread later;
  {
    WorkQueue queue({.workers = 1});
    ASSERT_TRUE(queue.push(make_placed([&](WorkQueue::Place& place) {
      {
        const WorkQueue::Pause pause(place);
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

// A worker that is busy until `release`, so that what is pushed meanwhile waits.
struct Busy {
  Event runs;
  Event release;
  void occupy(WorkQueue& queue) {
    ASSERT_TRUE(queue.push(make_task([this] {
      runs.set();
      EXPECT_TRUE(release.wait());
    })));
    ASSERT_TRUE(runs.wait());
  }
};

TEST(WorkQueue, GivesTurnsRoundTheClients) {
  std::string order;
  Event done;
  Busy busy;
  WorkQueue queue({.workers = 1, .capacity = 100});
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

TEST(WorkQueue, PassesOverAJobThatNoMemoryIsLeftFor) {
  MemoryGate gate({.capacity = 100}, [] {});
  auto taken = gate.take({.estimate = 50});
  Event light_ran;
  Event heavy_ran;
  WorkQueue queue({.workers = 1, .capacity = 10, .gate = &gate});
  queue.push(make_task([&] { heavy_ran.set(); }), {.client = "heavy", .estimate = 60});
  queue.push(make_task([&] { light_ran.set(); }), {.client = "light", .estimate = 10});
  ASSERT_TRUE(light_ran.wait());
  EXPECT_EQ(queue.waiting(), 1);
  taken.reset();
  queue.notify();
  EXPECT_TRUE(heavy_ran.wait());
}

TEST(WorkQueue, DoesNotPassOverAJobForEver) {
  MemoryGate gate({.capacity = 100}, [] {});
  auto taken = gate.take({.estimate = 50});
  std::atomic<int> light_runs{0};
  Event heavy_ran;
  Busy busy;
  WorkQueue queue({.workers = 1, .capacity = 1000, .gate = &gate});
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

TEST(WorkQueue, HasAWorkerForLightJobsWhileHeavyOnesWait) {
  Event ran;
  Busy busy;
  WorkQueue queue({.workers = 1, .workers_for_light = 1, .capacity = 10, .light = 10});
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
  EXPECT_EQ(queue.waiting(), 1);
  busy.release.set();
}

TEST(WorkQueue, LetsOneClientHaveItsShareOfWhatMayWait) {
  Busy busy;
  WorkQueue queue({.workers = 1, .capacity = 4, .client_share = 0.5});
  busy.occupy(queue);
  EXPECT_TRUE(pushed(queue, make_task([] {}), "a"));
  EXPECT_TRUE(pushed(queue, make_task([] {}), "a"));
  EXPECT_EQ(queue.push(make_task([] {}), {.client = "a"}), WorkQueue::Pushed::kClientFull);
  EXPECT_EQ(queue.capacity_of_client(), 2u);
  EXPECT_TRUE(pushed(queue, make_task([] {}), "b"));
  EXPECT_TRUE(pushed(queue, make_task([] {}), "c"));
  EXPECT_EQ(queue.push(make_task([] {}), {.client = "c"}), WorkQueue::Pushed::kQueueFull);
  busy.release.set();
}

TEST(WorkQueue, HasRoomForAClientOfWhomNothingWaitsUpToTwiceTheCapacity) {
  Busy busy;
  WorkQueue queue({.workers = 1, .capacity = 4, .client_share = 0.75});
  busy.occupy(queue);
  const auto push = [&](const char* client) {
    return queue.push(make_task([] {}), {.client = client, .estimate = 0});
  };
  for (const char* client : {"a", "a", "b", "b"}) EXPECT_EQ(push(client), WorkQueue::Pushed::kYes);
  EXPECT_EQ(push("a"), WorkQueue::Pushed::kQueueFull);
  for (const char* client : {"c", "d", "e", "f"}) {
    EXPECT_EQ(push(client), WorkQueue::Pushed::kYes);
    EXPECT_EQ(push(client), WorkQueue::Pushed::kQueueFull);
  }
  EXPECT_EQ(push("g"), WorkQueue::Pushed::kQueueFull);
  busy.release.set();
}

TEST(WorkQueue, LetsOneClientHaveItsShareOfThePlaces) {
  Event other_ran;
  Event release;
  std::atomic<int> running{0};
  WorkQueue queue({.workers = 4, .capacity = 40, .client_share = 0.75});
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
  while (queue.waiting() + queue.running() > 0) std::this_thread::yield();
}

TEST(WorkQueue, GivesTheLightPlaceOfAHeavyItemToAnotherAndWaitsForAMainOne) {
  Event light_ran;
  Event moves;
  Event moved;
  std::atomic<bool> has_moved{false};
  Busy busy;
  WorkQueue queue({.workers = 1, .workers_for_light = 1, .capacity = 10, .light = 10});
  Event heavy_runs;
  ASSERT_TRUE(pushed(queue, make_task([&] {
                       heavy_runs.set();
                       EXPECT_TRUE(busy.release.wait());
                     }),
                     "a", 1000));
  ASSERT_TRUE(heavy_runs.wait());
  ASSERT_TRUE(pushed(queue, make_placed([&](WorkQueue::Place& place) {
                       EXPECT_EQ(place.lane(), WorkQueue::Lane::kLight);
                       moves.set();
                       place.leave_light_lane(kNever);
                       EXPECT_EQ(place.lane(), WorkQueue::Lane::kMain);
                       has_moved = true;
                       moved.set();
                     }),
                     "b", 10));
  ASSERT_TRUE(moves.wait());
  ASSERT_TRUE(pushed(queue, make_task([&] { light_ran.set(); }), "c", 10));
  EXPECT_TRUE(light_ran.wait());
  EXPECT_FALSE(has_moved);
  EXPECT_EQ(queue.waiting(), 1u);
  EXPECT_EQ(queue.pausing(), 0u);
  busy.release.set();
  EXPECT_TRUE(moved.wait());
}

TEST(WorkQueue, LetsAnItemThatMovesGoOnOnceItIsStopped) {
  Event ended;
  Event moves;
  std::atomic<bool> stopped{false};
  Busy busy;
  WorkQueue queue({.workers = 1, .workers_for_light = 1, .capacity = 10, .light = 10});
  Event heavy_runs;
  ASSERT_TRUE(pushed(queue, make_task([&] {
                       heavy_runs.set();
                       EXPECT_TRUE(busy.release.wait());
                     }),
                     "a", 1000));
  ASSERT_TRUE(heavy_runs.wait());
  ASSERT_TRUE(pushed(queue, make_placed([&](WorkQueue::Place& place) {
                       moves.set();
                       place.leave_light_lane([&] { return stopped.load(); });
                       ended.set();
                     }),
                     "b", 10));
  ASSERT_TRUE(moves.wait());
  stopped = true;
  EXPECT_TRUE(ended.wait());
  busy.release.set();
}

// The main place is busy, so that only the light one is left.
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
    EXPECT_TRUE(pushed(queue_, make_placed([&](WorkQueue::Place& place) {
                         place.leave_light_lane([&] {
                           moves.set();
                           return true;
                         });
                       }),
                       client, 10));
    EXPECT_TRUE(moves.wait());
    // It waits for the other place until it has seen that it is to stop.
    while (queue_.running() > 1 || queue_.waiting() > 0) std::this_thread::yield();
  }

  Busy busy_;
  WorkQueue queue_{{.workers = 1,
                    .workers_for_light = 1,
                    .capacity = 10,
                    .light = 10,
                    .client_share = GetParam()}};
};

INSTANTIATE_TEST_SUITE_P(OfClients, DistrustInTheQueue, testing::Values(0.75, 1.0));

TEST_P(DistrustInTheQueue,
       KeepsTheLightPlaceFromAClientWhoseItemTurnedOutHeavyIfClientsAreToldApart) {
  turn_out_heavy("b");
  Event of_b;
  Event of_c;
  ASSERT_TRUE(pushed(queue_, make_task([&] { of_b.set(); }), "b", 10));
  ASSERT_TRUE(pushed(queue_, make_task([&] { of_c.set(); }), "c", 10));
  EXPECT_TRUE(of_c.wait());
  if (GetParam() < 1) {
    EXPECT_EQ(queue_.waiting(), 1u) << "b is for the main place";
  } else {
    EXPECT_TRUE(of_b.wait());
  }
  busy_.release.set();
  EXPECT_TRUE(of_b.wait());
}

TEST(WorkQueue, TrustsAClientAgainAfterAWhile) {
  Busy busy;
  WorkQueue queue({.workers = 1,
                   .workers_for_light = 1,
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
  ASSERT_TRUE(pushed(queue, make_placed([&](WorkQueue::Place& place) {
                       place.leave_light_lane([] { return true; });
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

// Lanes lend each other threads: at the end there are as many places as in the beginning.
TEST(WorkQueue, HasAllPlacesAgainAfterManyItemsHaveMoved) {
  constexpr int kMoving = 40;
  std::atomic<int> moved{0};
  std::atomic<int> running{0};
  WorkQueue queue({.workers = 2, .workers_for_light = 2, .capacity = 100, .light = 10});
  for (int i = 0; i < kMoving; ++i)
    ASSERT_TRUE(pushed(queue, make_placed([&](WorkQueue::Place& place) {
                         place.leave_light_lane(kNever);
                         EXPECT_LE(++running, 2);
                         std::this_thread::yield();
                         --running;
                         ++moved;
                       }),
                       "a", 10));
  while (moved < kMoving || queue.running() > 0) std::this_thread::yield();
  EXPECT_EQ(queue.waiting(), 0u);
  EXPECT_EQ(queue.pausing(), 0u);
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

}  // namespace
}  // namespace weft::server
