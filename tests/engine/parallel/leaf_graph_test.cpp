// SPDX-License-Identifier: Apache-2.0
// The leaves' tasks: that the orders of all phases fit together, and what the first fragments need.
#include "engine/parallel/leaf_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include "engine/parallel/block_graph.h"

namespace weft {
namespace {

// Leaves of different sizes over a rectangle.
Quadtree graded_tree(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const Point focus{3 * unit(), unit()};
  std::vector<Quadtree::Sample> samples;
  for (int i = 0; i < 20'000; ++i) {
    const double crowding = unit();
    samples.push_back(
        {{focus.x + crowding * (3 * unit() - focus.x), focus.y + crowding * (unit() - focus.y)},
         1});
  }
  Box domain;
  domain.add({0, 0});
  domain.add({3, 1});
  return Quadtree::build(domain, samples, 50);
}

struct Graph {
  explicit Graph(std::uint64_t seed, bool smooths)
      : order(graded_tree(seed)), tasks(order.size() * LeafGraph::kTasks) {
    LeafGraph::add_refinement(order, tasks);
    LeafGraph::add_emission(order, tasks, smooths);
  }
  LeafOrder order;
  TaskGraph tasks;
};

// The tasks in an order in which they may run, or fewer where some wait for one another.
std::vector<std::uint32_t> one_order(const TaskGraph& graph) {
  std::vector<std::vector<std::uint32_t>> successors(graph.size());
  std::vector<std::uint32_t> waits_for(graph.size(), 0);
  for (const auto& e : graph.edges()) {
    successors[e.before].push_back(e.after);
    ++waits_for[e.after];
  }
  std::vector<std::uint32_t> order;
  for (std::uint32_t t = 0; t < graph.size(); ++t) {
    if (waits_for[t] == 0) order.push_back(t);
  }
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (const std::uint32_t next : successors[order[i]]) {
      if (--waits_for[next] == 0) order.push_back(next);
    }
  }
  return order;
}

constexpr std::uint64_t kSeeds = 5;

TEST(LeafGraph, HasNoTasksThatWaitForOneAnother) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    for (const bool smooths : {false, true}) {
      const Graph graph(seed, smooths);
      ASSERT_GT(graph.order.size(), 200u);
      EXPECT_EQ(one_order(graph.tasks).size(), graph.tasks.size()) << seed;
    }
  }
}

TEST(LeafGraph, KnowsWhatTasksCostIfThereAreFewLeaves) {
  const ExecutionContext context;
  const auto costs = [&](double target) {
    std::vector<Quadtree::Sample> samples;
    for (int i = 0; i < 1024; ++i)
      samples.push_back({{(i % 32 + 0.5) / 32, (i / 32 + 0.5) / 32}, 1});
    const LeafOrder order(Quadtree::build({0, 0, 1, 1}, std::move(samples), target));
    const auto graph = BlockGraph::of_run(order, true, true, nullptr, nullptr, context);
    return std::pair(order.size(), graph->costs().size());
  };
  EXPECT_EQ(costs(4), std::pair(256u, std::size_t{LeafGraph::kTasks}));
  EXPECT_EQ(costs(1), std::pair(1024u, std::size_t{0}));
}

TEST(LeafGraph, KnowsTheFirstFragmentThatWaitsForATask) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    for (const bool smooths : {false, true}) {
      const Graph graph(seed, smooths);
      // Backwards over the graph, but for the order within the rounds that are skipped.
      std::vector<std::vector<std::uint32_t>> successors(graph.tasks.size());
      const auto is_skipped = [](std::uint32_t task) {
        const std::uint32_t step = task % LeafGraph::kTasks;
        return LeafGraph::kMigrationRounds <= step && step < LeafGraph::kRounds;
      };
      for (const auto& e : graph.tasks.edges()) {
        const bool of_one_leaf = e.before / LeafGraph::kTasks == e.after / LeafGraph::kTasks;
        if (!is_skipped(e.before) || !is_skipped(e.after) || of_one_leaf)
          successors[e.before].push_back(e.after);
      }
      std::vector<std::uint32_t> needs(graph.tasks.size(), graph.order.size());
      const auto order = one_order(graph.tasks);
      std::for_each(order.rbegin(), order.rend(), [&](std::uint32_t task) {
        const std::uint32_t leaf = task / LeafGraph::kTasks;
        if (task == LeafGraph::emit(leaf)) needs[task] = leaf;
        for (const std::uint32_t next : successors[task])
          needs[task] = std::min(needs[task], needs[next]);
      });
      EXPECT_EQ(LeafGraph::needs(graph.order, smooths), needs) << seed;
    }
  }
}

// A phase's order is one of all leaves, so it has no cycles; and the sweep's rows are what keeps
// chains short.
// A tree of blocks of some leaves each, as CoarseBlocks has it.
Quadtree blocks_over(const Quadtree& leaves, double weight) {
  std::vector<Quadtree::Sample> samples;
  for (const Quadtree::Leaf& leaf : leaves.leaves())
    samples.push_back(
        {{0.5 * (leaf.box.min_x + leaf.box.max_x), 0.5 * (leaf.box.min_y + leaf.box.max_y)},
         leaf.weight});
  Box domain;
  domain.add({0, 0});
  domain.add({3, 1});
  return Quadtree::build(domain, samples, weight);
}

TEST(BlockGraph, HasTheLeavesAndTheBlocksInOneGraph) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Quadtree leaves = graded_tree(seed);
    const Quadtree blocks = blocks_over(leaves, 500);
    const LeafOrder order(leaves);
    const LeafOrder of_blocks = LeafOrder::along_sweep(blocks);
    const BlocksNear near(blocks, leaves);
    ASSERT_GT(of_blocks.size(), 20u);
    ASSERT_LT(2 * of_blocks.size(), order.size());
    const std::uint32_t n = order.size();
    TaskGraph tasks((n + of_blocks.size()) * LeafGraph::kTasks);
    LeafGraph::add_refinement(order, tasks);
    LeafGraph::add_emission(order, tasks, true);
    BlockGraph::add(of_blocks, near, tasks);
    const std::vector<std::uint32_t> all = one_order(tasks);
    ASSERT_EQ(all.size(), tasks.size()) << seed;

    // A leaf begins after all tasks of the blocks whose tasks own anything in its halo.
    std::vector<std::uint32_t> place(all.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) place[all[i]] = i;
    for (std::uint32_t l = 0; l < n; ++l) {
      for (std::uint32_t b = 0; b < of_blocks.size(); ++b) {
        const Box& leaf = leaves.leaves()[l].halo;
        const Box& block = blocks.leaves()[b].halo;
        const bool overlap = leaf.min_x < block.max_x && block.min_x < leaf.max_x &&
                             leaf.min_y < block.max_y && block.min_y < leaf.max_y;
        ASSERT_EQ(std::count(near[l].begin(), near[l].end(), b), overlap ? 1 : 0) << l << ' ' << b;
        if (!overlap) continue;
        ASSERT_LT(place[BlockGraph::round(n + b, 1)], place[LeafGraph::round(l, 0)]);
        ASSERT_LT(place[BlockGraph::judge(n + b)], place[LeafGraph::round(l, 0)]);
      }
    }

    // Nothing that a task needs is needed later than the task itself.
    std::vector<std::uint32_t> needs = LeafGraph::needs(order, true);
    BlockGraph::add_needs(of_blocks, near, needs);
    ASSERT_EQ(needs.size(), tasks.size());
    for (const auto& e : tasks.edges()) {
      if (e.before / LeafGraph::kTasks < n) continue;
      ASSERT_LE(needs[e.before], needs[e.after]) << seed;
    }
  }
}

TEST(BlockGraph, JudgesABlockAfterTheRoundsOfThoseThatOverlap) {
  const Quadtree leaves = graded_tree(2);
  const Quadtree blocks = blocks_over(leaves, 500);
  const LeafOrder order = LeafOrder::along_sweep(blocks);
  TaskGraph tasks((static_cast<std::uint32_t>(leaves.leaves().size()) + order.size()) *
                  LeafGraph::kTasks);
  BlockGraph::add(order, BlocksNear(blocks, leaves), tasks);
  const auto n = static_cast<std::uint32_t>(leaves.leaves().size());
  const auto waits = [&](std::uint32_t before, std::uint32_t after) {
    return std::any_of(tasks.edges().begin(), tasks.edges().end(),
                       [&](const TaskEdge& e) { return e.before == before && e.after == after; });
  };
  for (std::uint32_t b = 0; b < order.size(); ++b) {
    for (const std::uint32_t other : order.overlapping(b))
      EXPECT_TRUE(waits(BlockGraph::round(n + other, 1), BlockGraph::judge(n + b))) << b;
  }
}

TEST(LeafGraph, OrdersOverlappingLeavesOneWayOrTheOther) {
  const LeafOrder order(graded_tree(1));
  for (const auto phase :
       {LeafOrder::kFirstRound, LeafOrder::kLaterRounds, LeafOrder::kSmoothing}) {
    std::vector<std::uint32_t> all = order.all(phase);
    for (std::size_t i = 1; i < all.size(); ++i) {
      ASSERT_TRUE(order.before(all[i - 1], all[i], phase));
      ASSERT_FALSE(order.before(all[i], all[i - 1], phase));
    }
    std::sort(all.begin(), all.end());
    for (std::uint32_t l = 0; l < all.size(); ++l) ASSERT_EQ(all[l], l);
  }
}

}  // namespace
}  // namespace weft
