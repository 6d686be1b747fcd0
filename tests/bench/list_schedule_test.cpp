// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/list_schedule.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "engine/parallel/task_graph.h"

namespace weft::bench {
namespace {

Trace::Graph graph_of(std::vector<double> seconds, std::vector<TaskEdge> edges) {
  Trace::Graph graph{.name = {"stage", {"even", "odd"}},
                     .seconds = std::move(seconds),
                     .skipped_by = {},
                     .edges = std::move(edges),
                     .fragment_tasks = {}};
  graph.skipped_by.assign(graph.seconds.size(), Trace::kNone);
  return graph;
}

TEST(ListSchedule, IndependentTasksShareTheThreads) {
  const auto graph = graph_of({1, 1, 1, 1}, {});
  EXPECT_DOUBLE_EQ(schedule(graph, 1, 0).seconds, 4);
  EXPECT_DOUBLE_EQ(schedule(graph, 2, 0).seconds, 2);
  EXPECT_DOUBLE_EQ(schedule(graph, 3, 0).seconds, 2);
  EXPECT_DOUBLE_EQ(schedule(graph, kUnboundedThreads, 0).seconds, 1);
}

TEST(ListSchedule, AChainTakesTheSumOnAnyNumberOfThreads) {
  const auto graph = graph_of({1, 2, 3}, {{0, 1}, {1, 2}});
  EXPECT_DOUBLE_EQ(schedule(graph, 64, 0).seconds, 6);
}

TEST(ListSchedule, TheReadyTaskWithTheLowestNumberGoesFirst) {
  // Task 2, which 3 waits for, comes after 0 and 1: a better order would take 3 seconds.
  const auto graph = graph_of({1, 1, 1, 2}, {{2, 3}});
  EXPECT_DOUBLE_EQ(schedule(graph, 2, 0).seconds, 4);
}

TEST(ListSchedule, TheReadyTaskThatIsNeededFirstGoesFirst) {
  auto graph = graph_of({1, 1, 1, 2}, {{2, 3}});
  graph.needs = {1, 1, 0, 0};
  EXPECT_DOUBLE_EQ(schedule(graph, 2, 0).seconds, 3);
}

TEST(ListSchedule, TheReadyTaskWithTheMostCostlyChainGoesFirst) {
  constexpr std::uint8_t kCosts[] = {1};
  auto graph = graph_of({1, 1, 1, 2}, {{2, 3}});
  graph.costs = kCosts;
  EXPECT_DOUBLE_EQ(schedule(graph, 2, 0).seconds, 3);
}

TEST(ListSchedule, WhatWaitsForASkippedTaskWaitsForTheOneThatSkippedIt) {
  // Task 1 would have waited for 2; 3 waits for 1, which 0 skips.
  auto graph = graph_of({1, 0, 5, 1}, {{0, 1}, {2, 1}, {1, 3}});
  graph.skipped_by[1] = 0;
  const Schedule two = schedule(graph, 2, 0);
  EXPECT_DOUBLE_EQ(two.seconds, 5);
  // On one thread 0, 2, 3 in some order: nothing is lost, nothing is run twice.
  EXPECT_DOUBLE_EQ(schedule(graph, 1, 0).seconds, 7);
}

TEST(ListSchedule, WithUnboundedThreadsTheChainIsTheCriticalPath) {
  const auto graph = graph_of({1, 4, 1, 1}, {{0, 1}, {0, 2}, {1, 3}, {2, 3}});
  const Schedule result = schedule(graph, kUnboundedThreads, 0);
  EXPECT_DOUBLE_EQ(result.seconds, 6);
  EXPECT_EQ(result.chain, (std::vector<std::uint32_t>{0, 1, 3}));
  const auto by_kind = seconds_by_kind(graph, result.chain);
  EXPECT_DOUBLE_EQ(by_kind.at("even"), 1);
  EXPECT_DOUBLE_EQ(by_kind.at("odd"), 5);
}

TEST(ListSchedule, FragmentsWaitForRoomBeforeTheFirstUnsentOne) {
  // Fragment 0 takes long; of the others only as many as fit may be built in the meantime.
  const std::uint32_t ahead = fragments_ahead(2);
  std::vector<double> seconds(2 * ahead, 1.0);
  seconds[0] = 10.0 * ahead;
  auto graph = graph_of(std::move(seconds), {});
  for (std::uint32_t t = 0; t < 2 * ahead; ++t) graph.fragment_tasks.push_back(t);
  // Then those that waited, ahead + 1 in all, go on both threads.
  EXPECT_DOUBLE_EQ(schedule(graph, 2, 0).seconds, 10.0 * ahead + ahead / 2.0);
}

TEST(ListSchedule, WhatHasBegunAheadOfTheNextFragmentIsBounded) {
  // Leaves of one task, each of which makes a fragment; that of the first takes long.
  const std::uint32_t begun = fragments_begun(10'000, 2);
  std::vector<double> seconds(10'000, 1.0);
  seconds[0] = 1e6;
  auto graph = graph_of(std::move(seconds), {});
  graph.name = {"stage", {"fragment"}};
  for (std::uint32_t t = 0; t < 10'000; ++t) {
    graph.fragment_tasks.push_back(t);
    graph.needs.push_back(t);
  }
  const Schedule result = schedule(graph, 2, 0);
  EXPECT_LE(result.most_begun, begun);
  EXPECT_GE(result.seconds, 1e6 + 0.5 * (10'000 - 2 * begun));
}

TEST(ListSchedule, SendingIsOneAfterTheOther) {
  auto graph = graph_of({1, 1, 1}, {});
  graph.fragment_tasks = {0, 1, 2};
  EXPECT_DOUBLE_EQ(schedule(graph, 3, 2).seconds, 7);
}

}  // namespace
}  // namespace weft::bench
