// SPDX-License-Identifier: Apache-2.0
// The tasks of the blocks of the coarse mesh (coarse_blocks.h), in the same graph as those of the
// leaves: block b has the tasks of a leaf (leaf_graph.h) with the number n + b, if there are n
// leaves.
//
//   const BlocksNear near(block_tree, tree);
//   Result<TaskGraph> graph =
//       BlockGraph::of_run(order, true, smooths, &block_order, &near, context);
//
// A block has two rounds and a judging task; its other tasks are empty. Each of these waits for the
// overlapping blocks, and the leaves' first round waits until the blocks around are judged.
//
// Thread-safety: BlocksNear is immutable once built; the rest are pure functions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/context.h"
#include "engine/parallel/leaf_graph.h"
#include "engine/parallel/leaf_order.h"
#include "engine/parallel/quadtree.h"
#include "engine/parallel/task_graph.h"
#include "weft/error.h"

namespace weft {

// Per leaf, the blocks whose halos overlap the leaf's own.
class BlocksNear {
 public:
  // From the trees of the blocks and of the leaves.
  BlocksNear(const Quadtree& blocks, const Quadtree& leaves);

  std::uint32_t leaves() const { return static_cast<std::uint32_t>(first_.size() - 1); }
  // The blocks of a leaf, in any order.
  std::span<const std::uint32_t> operator[](std::uint32_t leaf) const {
    return {blocks_.data() + first_[leaf], blocks_.data() + first_[leaf + 1]};
  }
  std::uint64_t bytes() const {
    return (first_.capacity() + blocks_.capacity()) * sizeof(std::uint32_t);
  }

 private:
  std::vector<std::uint32_t> first_;  // per leaf, and one more: into blocks_
  std::vector<std::uint32_t> blocks_;
};

struct BlockGraph {
  // The task of a block. Blocks are numbered after the leaves.
  static std::uint32_t round(std::uint32_t number, std::uint32_t round) {
    return LeafGraph::round(number, round);
  }
  static std::uint32_t judge(std::uint32_t number) { return LeafGraph::round(number, kRounds); }
  static constexpr std::uint32_t kRounds = LeafGraph::kMigrationRounds;

  // The graph of all tasks that run while a mesh is refined: with the fragments of the leaves if it
  // `streams`, and the blocks' tasks if there are blocks. Errors: kCancelled, kDeadlineExceeded.
  static Result<TaskGraph> of_run(const LeafOrder& leaves, bool streams, bool smooths,
                                  const LeafOrder* blocks, const BlocksNear* near,
                                  const ExecutionContext& context);
  static void add(const LeafOrder& blocks, const BlocksNear& near, TaskGraph& graph);
  // Appends the needs of the blocks' tasks to those of the leaves.
  static void add_needs(const LeafOrder& blocks, const BlocksNear& near,
                        std::vector<std::uint32_t>& needs);
};

}  // namespace weft
