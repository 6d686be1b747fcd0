// SPDX-License-Identifier: Apache-2.0
#include "engine/parallel/task_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <random>
#include <thread>

#include "tests/support/event.h"

namespace weft {
namespace {

using Edges = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

// A graph whose edges lead from lower to higher numbers of a random permutation.
struct RandomGraph {
  RandomGraph(std::uint32_t tasks, std::uint64_t seed) : graph(tasks) {
    std::mt19937_64 random(seed);
    std::vector<std::uint32_t> order(tasks);
    for (std::uint32_t t = 0; t < tasks; ++t) order[t] = t;
    std::shuffle(order.begin(), order.end(), random);
    for (std::uint32_t n = 3 * tasks; n > 0; --n) {
      const auto a = static_cast<std::uint32_t>(random() % tasks);
      const auto b = static_cast<std::uint32_t>(random() % tasks);
      if (a == b) continue;
      edges.push_back({order[std::min(a, b)], order[std::max(a, b)]});
      graph.add_dependency(edges.back().first, edges.back().second);
    }
  }
  TaskGraph graph;
  Edges edges;
};

// Records when tasks begin and end. These are plain integers, so that ThreadSanitizer also judges
// whether what a task wrote is visible to tasks that depend on it.
class Record {
 public:
  explicit Record(const RandomGraph& g) : edges_(g.edges), ended_(g.graph.size(), 0) {
    before_.resize(g.graph.size());
    for (const auto& [before, after] : edges_) before_[after].push_back(before);
  }
  void run(std::uint32_t task) {
    for (const std::uint32_t b : before_[task]) {
      if (ended_[b] != 1) ++early_;
    }
    ++ended_[task];
  }
  // "" when each task ran once, after all that it waits for.
  std::string fault() const {
    if (early_ > 0) return "a task ran before one that it waits for";
    for (const int n : ended_) {
      if (n != 1) return "a task ran " + std::to_string(n) + " times";
    }
    return "";
  }

 private:
  Edges edges_;
  std::vector<std::vector<std::uint32_t>> before_;
  std::vector<int> ended_;
  std::atomic<int> early_{0};
};

void finish(GraphRun& run) {
  run.start();
  while (run.step()) {
  }
}

class TaskGraphs : public testing::TestWithParam<int> {
 protected:
  // No arena for 0 threads.
  Arena* arena() { return arena_ ? &*arena_ : nullptr; }
  int threads() const { return std::max(1, GetParam()); }

 private:
  std::optional<Arena> arena_ = GetParam() > 0 ? std::make_optional<Arena>(GetParam())
                                               : std::nullopt;
};

TEST_P(TaskGraphs, RunEachTaskOnceAfterThoseItWaitsFor) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const RandomGraph g(500, seed);
    Record record(g);
    GraphRun run(g.graph, arena(), threads(), [&](std::uint32_t task) { record.run(task); });
    finish(run);
    ASSERT_EQ(record.fault(), "") << "seed " << seed;
  }
}

TEST_P(TaskGraphs, WithNoTaskAreDone) {
  GraphRun run(TaskGraph(0), arena(), threads(), [](std::uint32_t) { FAIL(); });
  finish(run);
}

TEST_P(TaskGraphs, HoldATaskUntilItIsReleased) {
  TaskGraph graph(3);
  graph.add_dependency(1, 2);
  graph.hold(1);
  std::vector<std::uint32_t> ran;
  GraphRun run(graph, arena(), threads(), [&](std::uint32_t task) { ran.push_back(task); });
  finish(run);
  ASSERT_EQ(ran, (std::vector<std::uint32_t>{0}));
  run.release(1);
  while (run.step()) {
  }
  EXPECT_EQ(ran, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST_P(TaskGraphs, TakeAReleaseBeforeTheTaskIsReady) {
  TaskGraph graph(2);
  graph.add_dependency(0, 1);
  graph.hold(1);
  std::vector<std::uint32_t> ran;
  GraphRun run(graph, arena(), threads(), [&](std::uint32_t task) { ran.push_back(task); });
  run.release(1);
  finish(run);
  EXPECT_EQ(ran, (std::vector<std::uint32_t>{0, 1}));
}

TEST_P(TaskGraphs, PassOverASkippedTask) {
  // 0 skips 1, for which 2 waits; 3 waits for all.
  TaskGraph graph(4);
  graph.add_dependency(0, 1);
  graph.add_dependency(1, 2);
  for (std::uint32_t t = 0; t < 3; ++t) graph.add_dependency(t, 3);
  std::vector<std::uint32_t> ran;
  std::unique_ptr<GraphRun> run;
  run = std::make_unique<GraphRun>(graph, arena(), threads(), [&](std::uint32_t task) {
    ran.push_back(task);
    if (task == 0) run->skip(1);
  });
  finish(*run);
  EXPECT_EQ(ran, (std::vector<std::uint32_t>{0, 2, 3}));
}

TEST_P(TaskGraphs, PassOverAChainOfSkippedTasksFromTheLast) {
  TaskGraph graph(5);
  for (std::uint32_t t = 0; t < 4; ++t) graph.add_dependency(t, t + 1);
  std::vector<std::uint32_t> ran;
  std::unique_ptr<GraphRun> run;
  run = std::make_unique<GraphRun>(graph, arena(), threads(), [&](std::uint32_t task) {
    ran.push_back(task);
    for (std::uint32_t later = 4; task == 0 && --later > 0;) run->skip(later);
  });
  finish(*run);
  EXPECT_EQ(ran, (std::vector<std::uint32_t>{0, 4}));
}

TEST_P(TaskGraphs, DropWhatHasNotBegunWhenDestroyed) {
  const RandomGraph g(500, 1);
  std::atomic<int> running{0};
  std::atomic<int> ran{0};
  for (int i = 0; i < 20; ++i) {
    Event begun;
    {
      GraphRun run(g.graph, arena(), threads(), [&](std::uint32_t) {
        ++running;
        begun.set();
        std::this_thread::yield();
        ++ran;
        --running;
      });
      run.start();
      if (!arena()) run.step();
      ASSERT_TRUE(begun.wait());
    }
    ASSERT_EQ(running, 0);
  }
  EXPECT_LE(ran, 20 * 500);
}

TEST_P(TaskGraphs, DropAHeldTaskWhenDestroyed) {
  TaskGraph graph(2);
  graph.hold(1);
  std::atomic<int> ran{0};
  {
    GraphRun run(graph, arena(), threads(), [&](std::uint32_t) { ++ran; });
    finish(run);
  }
  EXPECT_EQ(ran, 1);
}

INSTANTIATE_TEST_SUITE_P(With, TaskGraphs, testing::Values(0, 1, 2, 3, 4, 7, 16),
                         [](const auto& info) {
                           return info.param == 0 ? std::string("NoArena")
                                                  : std::to_string(info.param) + "Threads";
                         });

TEST(TaskGraph, RunsTheReadyTaskWithTheLowestNumberFirst) {
  TaskGraph graph(6);
  graph.add_dependency(4, 0);
  std::vector<std::uint32_t> ran;
  GraphRun run(graph, nullptr, 1, [&](std::uint32_t task) { ran.push_back(task); });
  finish(run);
  EXPECT_EQ(ran, (std::vector<std::uint32_t>{1, 2, 3, 4, 0, 5}));
}

TEST(TaskGraph, RunsTheReadyTaskThatIsNeededFirst) {
  TaskGraph graph(6);
  graph.add_dependency(4, 0);
  graph.set_needs({0, 3, 2, 2, 1, 0});
  std::vector<std::uint32_t> ran;
  GraphRun run(graph, nullptr, 1, [&](std::uint32_t task) { ran.push_back(task); });
  finish(run);
  EXPECT_EQ(ran, (std::vector<std::uint32_t>{5, 4, 0, 2, 3, 1}));
}

// A chain of three short tasks, 1 to 3, beside a long one and one that waits for 3.
constexpr std::uint8_t kLongFirst[] = {5, 2, 2, 2, 1};
TaskGraph chain_beside_a_long_task() {
  TaskGraph graph(5);
  graph.add_dependency(1, 2);
  graph.add_dependency(2, 3);
  graph.add_dependency(3, 4);
  graph.set_needs({0, 1, 1, 1, 1});
  graph.set_costs(kLongFirst);
  return graph;
}

TEST(TaskGraph, RanksTasksByTheCostOfTheChainsAfterThem) {
  const TaskGraph graph = chain_beside_a_long_task();
  const TaskRanks ranks = rank_tasks(5, graph.edges(), graph.needs(), graph.costs(), 2);
  EXPECT_EQ(ranks.of, (std::vector<std::uint32_t>{2, 0, 2, 4, 6}));
  EXPECT_FALSE(ranks.hold);
}

TEST(TaskGraph, RanksTasksByNeedIfOneThreadWorksOrTheHoldWouldKeepSomeBack) {
  TaskGraph graph = chain_beside_a_long_task();
  EXPECT_EQ(rank_tasks(5, graph.edges(), graph.needs(), graph.costs(), 1).of, graph.needs());
  const std::uint32_t far = 1000;
  ASSERT_LT(fragments_begun(far + 1, 2), far);
  graph.set_needs({0, 1, 2, 3, far});
  const TaskRanks ranks = rank_tasks(5, graph.edges(), graph.needs(), graph.costs(), 2);
  EXPECT_EQ(ranks.of, graph.needs());
  EXPECT_TRUE(ranks.hold);
}

TEST(TaskGraph, HoldsNothingIfTasksRunByTheirChains) {
  Arena arena(2);
  std::atomic<std::uint32_t> ran{0};
  GraphRun run(chain_beside_a_long_task(), &arena, 2, [&](std::uint32_t) { ++ran; });
  run.start();  // the fragments that may begin are up to 0, and 2 to 4 are needed by the next
  while (ran < 5 && run.idle_since() == std::nullopt) std::this_thread::yield();
  while (run.idle_since() == std::nullopt) std::this_thread::yield();
  EXPECT_EQ(ran, 5u);
}

// Ten tasks that wait for nothing; each is needed by the fragment of its number.
TaskGraph ten_needed_in_turn() {
  TaskGraph graph(10);
  graph.set_needs({0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
  return graph;
}

TEST(TaskGraph, BeginsWhatFarFragmentsNeedOnlyWhileTheCallerWaits) {
  Arena arena(2);
  std::atomic<std::uint32_t> ran{0};
  GraphRun run(ten_needed_in_turn(), &arena, 2, [&](std::uint32_t) { ++ran; });
  run.begin_up_to(3, 9);
  run.start();
  arena.run([] {});  // after what was started
  while (run.idle_since() == std::nullopt) std::this_thread::yield();
  EXPECT_EQ(ran, 4u);
  run.begin_up_to(5, 9);
  while (ran < 6) std::this_thread::yield();
  while (run.idle_since() == std::nullopt) std::this_thread::yield();
  EXPECT_EQ(ran, 6u);
  while (run.step()) {
  }
  EXPECT_EQ(ran, 10u);
}

TEST(TaskGraph, BeginsWhatIsBeyondTheBoundOneByOneWhileTheCallerWaits) {
  Arena arena(4);
  std::atomic<int> inside{0};
  std::atomic<int> most{0};
  std::atomic<std::uint32_t> ran{0};
  GraphRun run(ten_needed_in_turn(), &arena, 4, [&](std::uint32_t) {
    const int now = ++inside;
    if (now > most) most = now;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    --inside;
    ++ran;
  });
  finish(run);
  EXPECT_EQ(ran, 10u);
  EXPECT_EQ(most, 1);
}

TEST(TaskGraph, RunsEachTaskOnceWhateverIsHeld) {
  for (const int threads : {1, 2, 7}) {
    Arena arena(threads);
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      RandomGraph g(300, seed);
      std::mt19937_64 random(seed);
      std::vector<std::uint32_t> needs(300);
      for (auto& need : needs) need = static_cast<std::uint32_t>(random() % 50);
      g.graph.set_needs(needs);
      Record record(g);
      GraphRun run(g.graph, &arena, threads, [&](std::uint32_t task) { record.run(task); });
      run.start();
      for (std::uint32_t fragment = 0; run.step(); ++fragment)
        run.begin_up_to(fragment / 2, fragment);
      ASSERT_EQ(record.fault(), "") << "seed " << seed;
    }
  }
}

TEST(TaskGraph, RunsAsManyTasksAtOnceAsItMayUseThreads) {
  constexpr int kThreads = 4;
  Arena arena(kThreads);
  std::mutex mutex;
  std::condition_variable changed;
  int inside = 0;
  // None of the four ends before all are there.
  GraphRun run(TaskGraph(kThreads), &arena, kThreads, [&](std::uint32_t) {
    std::unique_lock lock(mutex);
    ++inside;
    changed.notify_all();
    EXPECT_TRUE(changed.wait_for(lock, kPatience, [&] { return inside == kThreads; }));
  });
  finish(run);
}

TEST(TaskGraph, TakesNoMoreThreadsThanItsShareOfTheArena) {
  Arena arena(8);
  std::atomic<int> inside{0};
  std::atomic<int> most{0};
  GraphRun run(TaskGraph(2000), &arena, 2, [&](std::uint32_t) {
    const int now = ++inside;
    int seen = most;
    while (now > seen && !most.compare_exchange_weak(seen, now)) {
    }
    std::this_thread::yield();
    --inside;
  });
  finish(run);
  EXPECT_LE(most, 2);
  EXPECT_GE(most, 1);
}

TEST(TaskGraph, StepReturnsAtTheEndOfASliceOnceNotified) {
  constexpr std::uint32_t kTasks = 1000;
  Arena arena(1);
  TaskGraph graph(kTasks);
  for (std::uint32_t t = 1; t < kTasks; ++t) graph.add_dependency(t - 1, t);
  std::atomic<bool> returned = false;
  std::uint32_t waiting = 0;  // tasks that ran before `step` had returned
  std::unique_ptr<GraphRun> run;
  run = std::make_unique<GraphRun>(graph, &arena, 1, [&](std::uint32_t task) {
    if (task == 30) run->notify();  // by now `step` waits
    if (returned) return;
    ++waiting;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  });
  run->start();
  EXPECT_TRUE(run->step());
  returned = true;
  while (run->step()) {
  }
  EXPECT_LT(waiting, kTasks);
}

TEST(TaskGraph, StepReturnsOnceNotifiedWhereAThreadFindsNothingMoreToDo) {
  Arena arena(2);
  TaskGraph graph(2);
  Event started;
  Event returned;
  std::unique_ptr<GraphRun> run;
  run = std::make_unique<GraphRun>(graph, &arena, 2, [&](std::uint32_t task) {
    if (task == 1) {
      started.set();
      EXPECT_TRUE(returned.wait());
    } else {
      EXPECT_TRUE(started.wait());
      run->notify();
    }
  });
  run->start();
  EXPECT_TRUE(run->step());
  returned.set();
  while (run->step()) {
  }
}

TEST(TaskGraph, RunsOfManyJobsShareOneArena) {
  Arena arena(4);
  std::vector<std::thread> jobs;
  std::vector<std::string> faults(8);
  for (std::size_t j = 0; j < faults.size(); ++j) {
    jobs.emplace_back([&, j] {
      for (std::uint64_t seed = 0; seed < 5 && faults[j].empty(); ++seed) {
        const RandomGraph g(300, 100 * j + seed);
        Record record(g);
        GraphRun run(g.graph, &arena, 4, [&](std::uint32_t task) { record.run(task); });
        finish(run);
        faults[j] = record.fault();
      }
    });
  }
  for (std::thread& job : jobs) job.join();
  for (const std::string& fault : faults) EXPECT_EQ(fault, "");
}

TEST(TaskGraph, GivesTheArenaToAnotherJobBetweenItsTasks) {
  // One thread for both: the second job must be done while the first one still has tasks.
  Arena arena(1);
  std::atomic<bool> enough{false};
  std::atomic<std::uint32_t> done{0};
  constexpr std::uint32_t kMany = 1'000'000;
  GraphRun first(TaskGraph(kMany), &arena, 1, [&](std::uint32_t) {
    if (!enough) std::this_thread::sleep_for(std::chrono::microseconds(100));
    ++done;
  });
  first.start();
  bool ran = false;
  GraphRun second(TaskGraph(1), &arena, 1, [&](std::uint32_t) { ran = true; });
  finish(second);
  EXPECT_TRUE(ran);
  EXPECT_LT(done, kMany);
  enough = true;
  while (first.step()) {
  }
  EXPECT_EQ(done, kMany);
}

}  // namespace
}  // namespace weft
