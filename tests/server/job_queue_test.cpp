// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/job_queue.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/server/harness.h"

namespace weft::server {
namespace {

using testing::Event;

class Task final : public JobQueue::Job {
 public:
  explicit Task(std::function<void()> work) : work_(std::move(work)) {}
  void run() noexcept override { work_(); }

 private:
  std::function<void()> work_;
};

std::shared_ptr<Task> make_task(std::function<void()> work) {
  return std::make_shared<Task>(std::move(work));
}

TEST(JobQueue, RunsAsManyJobsAtOnceAsItHasWorkers) {
  Event first_runs;
  Event second_runs;
  JobQueue queue(2, 0);
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
  JobQueue queue(1, 1);
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
  JobQueue queue(1, 1);
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

}  // namespace
}  // namespace weft::server
