// SPDX-License-Identifier: Apache-2.0
#include "server/job_queue.h"

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <thread>

#include "tests/server/harness.h"

namespace weft::server {
namespace {

using testing::Event;

class Task final : public JobQueue::Job {
 public:
  explicit Task(std::function<void()> work) : work_(std::move(work)) {}
  void run(JobQueue::Lane) noexcept override { work_(); }

 private:
  std::function<void()> work_;
};

std::shared_ptr<Task> make_task(std::function<void()> work) {
  return std::make_shared<Task>(std::move(work));
}

TEST(JobQueue, RunsAsManyJobsAtOnceAsItHasWorkers) {
  Event first_runs;
  Event second_runs;
  JobQueue queue({.workers = 2});
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

TEST(JobQueue, RefusesWhatIsOverItsCapacity) {
  Event runs;
  Event release;
  JobQueue queue({.workers = 1, .capacity = 1});
  ASSERT_TRUE(queue.push(make_task([&] {
    runs.set();
    EXPECT_TRUE(release.wait());
  })));
  ASSERT_TRUE(runs.wait());
  EXPECT_TRUE(queue.push(make_task([] {})));
  EXPECT_FALSE(queue.push(make_task([] {})));
  release.set();
}

TEST(JobQueue, GivesBackAJobThatHasNotBegunAndNoOther) {
  Event runs;
  Event release;
  JobQueue queue({.workers = 1, .capacity = 1});
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

// A worker that is busy until `release`, so that what is pushed meanwhile waits.
struct Busy {
  Event runs;
  Event release;
  void occupy(JobQueue& queue) {
    ASSERT_TRUE(queue.push(make_task([this] {
      runs.set();
      EXPECT_TRUE(release.wait());
    })));
    ASSERT_TRUE(runs.wait());
  }
};

TEST(JobQueue, GivesTurnsRoundTheClients) {
  std::string order;
  Event done;
  Busy busy;
  JobQueue queue({.workers = 1, .capacity = 100});
  busy.occupy(queue);
  for (const char* job : {"a", "a", "a", "b", "b", "c"})
    queue.push(make_task([&, job] {
                 order += job;
                 if (order.size() == 6) done.set();
               }),
               {.client = job, .weight = 0});
  busy.release.set();
  ASSERT_TRUE(done.wait());
  EXPECT_EQ(order, "abcaba");
}

TEST(JobQueue, PassesOverAJobThatNoMemoryIsLeftFor) {
  MemoryGate gate(100, [] {});
  auto taken = gate.take(50);
  Event light_ran;
  Event heavy_ran;
  JobQueue queue({.workers = 1, .capacity = 10, .gate = &gate});
  queue.push(make_task([&] { heavy_ran.set(); }), {.client = "heavy", .weight = 60});
  queue.push(make_task([&] { light_ran.set(); }), {.client = "light", .weight = 10});
  ASSERT_TRUE(light_ran.wait());
  EXPECT_EQ(queue.waiting(), 1);
  taken.reset();
  queue.notify();
  EXPECT_TRUE(heavy_ran.wait());
}

TEST(JobQueue, DoesNotPassOverAJobForEver) {
  MemoryGate gate(100, [] {});
  auto taken = gate.take(50);
  std::atomic<int> light_runs{0};
  Event heavy_ran;
  Busy busy;
  JobQueue queue({.workers = 1, .capacity = 1000, .gate = &gate});
  busy.occupy(queue);
  queue.push(make_task([&] { heavy_ran.set(); }), {.client = "heavy", .weight = 60});
  for (int i = 0; i < 500; ++i)
    queue.push(make_task([&] { ++light_runs; }), {.client = "light", .weight = 10});
  busy.release.set();
  while (light_runs < 60) std::this_thread::yield();
  queue.notify();
  EXPECT_LT(light_runs, 200);
  taken.reset();
  queue.notify();
  EXPECT_TRUE(heavy_ran.wait());
}

TEST(JobQueue, HasAWorkerForLightJobsWhileHeavyOnesWait) {
  Event ran;
  Busy busy;
  JobQueue queue({.workers = 1, .workers_for_light = 1, .capacity = 10, .light = 10});
  Event heavy_runs;
  queue.push(make_task([&] {
               heavy_runs.set();
               EXPECT_TRUE(busy.release.wait());
             }),
             {.client = "a", .weight = 1000});
  ASSERT_TRUE(heavy_runs.wait());
  queue.push(make_task([] {}), {.client = "a", .weight = 1000});
  queue.push(make_task([&] { ran.set(); }), {.client = "a", .weight = 10});
  EXPECT_TRUE(ran.wait());
  EXPECT_EQ(queue.waiting(), 1);
  busy.release.set();
}

}  // namespace
}  // namespace weft::server
