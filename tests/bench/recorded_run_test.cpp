// SPDX-License-Identifier: GPL-3.0-or-later
// A run of the engine that a trace records, and the schedule that follows from it on other numbers
// of threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string_view>

#include "bench/list_schedule.h"
#include "engine/engine.h"

namespace weft::bench {
namespace {

struct Discard : ChunkSink {
  bool accept(Chunk&&) override { return true; }
};

// A square of about 30,000 triangles in some 100 leaves.
MeshRequest square(double leaf_triangles = 500) {
  return {.pslg = {.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}},
                   .segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}}},
          .size = 5e-5,
          .leaf_triangles = leaf_triangles};
}

struct Recording {
  Trace trace;
  Summary summary;
  double seconds = 0;
};

void run_square(Recording& run, double leaf_triangles = 500) {
  Discard sink;
  ExecutionContext context;
  context.set_trace(run.trace);
  const auto start = Trace::Clock::now();
  const auto summary = generate_mesh(square(leaf_triangles), sink, context);
  run.seconds = std::chrono::duration<double>(Trace::Clock::now() - start).count();
  ASSERT_TRUE(summary) << summary.error().message;
  run.summary = *summary;
}

const Trace::Graph& leaves_of(const Trace& trace) {
  const auto stage = std::find_if(trace.stages.begin(), trace.stages.end(),
                                  [](const Trace::Stage& s) { return s.graph.has_value(); });
  return *stage->graph;
}

bool has_stage(const Trace& trace, std::string_view name) {
  return std::any_of(trace.stages.begin(), trace.stages.end(),
                     [&](const Trace::Stage& s) { return s.name == name; });
}

TEST(RecordedRun, MakesTheCoarseMeshOfManyLeavesInBlocks) {
  Recording many;
  run_square(many);
  EXPECT_TRUE(has_stage(many.trace, "blocks"));
  Recording few;
  run_square(few, 2000);
  EXPECT_GT(few.summary.leaves.size(), 8u);
  EXPECT_FALSE(has_stage(few.trace, "blocks"));
}

TEST(RecordedRun, StagesAddUpToTheRunAndNoMore) {
  Recording run;
  run_square(run);
  double sum = 0;
  for (const Trace::Stage& stage : run.trace.stages) {
    EXPECT_GE(stage.seconds, 0) << stage.name;
    sum += stage.seconds;
  }
  EXPECT_LE(sum, run.seconds);
  EXPECT_GT(sum, 0.1 * run.seconds);
}

TEST(RecordedRun, TasksOfAStageTakeNoLongerThanTheStageOnOneThread) {
  Recording run;
  run_square(run);
  for (const Trace::Stage& stage : run.trace.stages) {
    if (stage.graph) {
      EXPECT_LE(work_of(*stage.graph), stage.seconds) << stage.name;
    }
  }
}

TEST(RecordedRun, ATaskRunsOrIsSkippedByOneThatItWaitsForAndThatRan) {
  Recording run;
  run_square(run);
  const Trace::Graph& graph = leaves_of(run.trace);
  std::size_t skipped = 0;
  for (std::uint32_t t = 0; t < graph.seconds.size(); ++t) {
    const std::uint32_t by = graph.skipped_by[t];
    if (by == Trace::kNone) {
      EXPECT_GT(graph.seconds[t], 0) << t;
      continue;
    }
    ++skipped;
    EXPECT_EQ(graph.seconds[t], 0) << t;
    EXPECT_EQ(graph.skipped_by[by], Trace::kNone) << t;
    EXPECT_EQ(by / graph.name.period(), t / graph.name.period()) << "of the same leaf";
  }
  EXPECT_GT(skipped, 0u);
}

TEST(RecordedRun, EachLeafHasAFragment) {
  Recording run;
  run_square(run);
  EXPECT_EQ(leaves_of(run.trace).fragment_tasks.size(), run.summary.leaves.size());
}

TEST(RecordedRun, TheScheduleOnOneThreadTakesTheWorkAndNoScheduleTakesLessThanItsShare) {
  Recording run;
  run_square(run);
  const Trace::Graph& graph = leaves_of(run.trace);
  const double work = work_of(graph);
  EXPECT_NEAR(schedule(graph, 1, 0).seconds, work, 1e-9 * work);
  const double path = schedule(graph, kUnboundedThreads, 0).seconds;
  for (const int threads : {2, 3, 8, 64}) {
    const double seconds = schedule(graph, threads, 0).seconds;
    EXPECT_GE(seconds, work / threads * (1 - 1e-9)) << threads;
    EXPECT_GE(seconds, path * (1 - 1e-9)) << threads;
    EXPECT_LE(seconds, work * (1 + 1e-9)) << threads;
  }
}

TEST(RecordedRun, FragmentsDoNotWaitForOneAnother) {
  // A chain of fragments through the leaves in their order would bound the speed-up.
  Recording run;
  run_square(run);
  const Trace::Graph& graph = leaves_of(run.trace);
  const Schedule path = schedule(graph, kUnboundedThreads, 0);
  const auto fragments =
      std::count_if(path.chain.begin(), path.chain.end(), [&](std::uint32_t task) {
        return std::find(graph.fragment_tasks.begin(), graph.fragment_tasks.end(), task) !=
               graph.fragment_tasks.end();
      });
  EXPECT_LE(fragments, 1);
}

TEST(RecordedRun, ATraceLeavesTheMeshAsItIs) {
  Recording run;
  run_square(run);
  Discard sink;
  ExecutionContext context;
  const auto plain = generate_mesh(square(), sink, context);
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->digest, run.summary.digest);
}

}  // namespace
}  // namespace weft::bench
