// SPDX-License-Identifier: Apache-2.0
#include "engine/parallel/block_graph.h"

#include <algorithm>
#include <utility>

namespace weft {
BlocksNear::BlocksNear(const Quadtree& blocks, const Quadtree& leaves) {
  first_.reserve(leaves.leaves().size() + 1);
  first_.push_back(0);
  for (const Quadtree::Leaf& leaf : leaves.leaves()) {
    blocks.for_overlapping(leaf.halo, [&](std::uint32_t b) { blocks_.push_back(b); });
    first_.push_back(static_cast<std::uint32_t>(blocks_.size()));
  }
}

Result<TaskGraph> BlockGraph::of_run(const LeafOrder& leaves, bool streams, bool smooths,
                                     const LeafOrder* blocks, const BlocksNear* near,
                                     const ExecutionContext& context) {
  TaskGraph graph((leaves.size() + (blocks ? blocks->size() : 0)) * LeafGraph::kTasks);
  LeafGraph::add_refinement(leaves, graph);
  if (leaves.size() <= LeafOrder::kFewLeaves) graph.set_costs(LeafGraph::kCosts);
  if (!streams) return graph;
  if (auto error = context.poll()) return tl::unexpected(*error);
  LeafGraph::add_emission(leaves, graph, smooths);
  if (auto error = context.poll()) return tl::unexpected(*error);
  std::vector<std::uint32_t> needs = LeafGraph::needs(leaves, smooths);
  if (auto error = context.poll()) return tl::unexpected(*error);
  if (blocks) {
    add(*blocks, *near, graph);
    add_needs(*blocks, *near, needs);
  }
  graph.set_needs(std::move(needs));
  return graph;
}

void BlockGraph::add(const LeafOrder& blocks, const BlocksNear& near, TaskGraph& graph) {
  const std::uint32_t n = near.leaves();
  for (std::uint32_t b = 0; b < blocks.size(); ++b) {
    const std::uint32_t number = n + b;
    for (std::uint32_t task = round(number, 1); task <= LeafGraph::emit(number); ++task)
      graph.add_dependency(task - 1, task);
    for (const std::uint32_t other : blocks.overlapping(b)) {
      for (std::uint32_t r = 0; r < kRounds; ++r) {
        if (blocks.before(other, b, LeafOrder::phase_of(r))) {
          graph.add_dependency(round(n + other, r), round(number, r));
        } else if (r > 0) {
          graph.add_dependency(round(n + other, r - 1), round(number, r));
        }
      }
      graph.add_dependency(round(n + other, kRounds - 1), judge(number));
    }
  }
  for (std::uint32_t l = 0; l < n; ++l) {
    for (const std::uint32_t b : near[l])
      graph.add_dependency(judge(n + b), LeafGraph::round(l, 0));
  }
}

void BlockGraph::add_needs(const LeafOrder& blocks, const BlocksNear& near,
                           std::vector<std::uint32_t>& needs) {
  const std::uint32_t n = near.leaves();
  std::vector<std::uint32_t> judged(blocks.size(), n);
  for (std::uint32_t l = 0; l < n; ++l) {
    for (const std::uint32_t b : near[l])
      judged[b] = std::min(judged[b], needs[LeafGraph::round(l, 0)]);
  }
  const LeafGraph::RoundNeeds rounds = LeafGraph::needs_of_rounds(blocks, judged);
  needs.resize(needs.size() + std::size_t{blocks.size()} * LeafGraph::kTasks, n);
  for (std::uint32_t b = 0; b < blocks.size(); ++b) {
    needs[round(n + b, 0)] = rounds.first[b];
    needs[round(n + b, 1)] = rounds.second[b];
    needs[judge(n + b)] = judged[b];
  }
}

}  // namespace weft
