// SPDX-License-Identifier: Apache-2.0
// Which leaves' tasks are in conflict, for their grown boxes overlap, and which of two in conflict
// comes first: the one of the lower colour, of a greedy colouring in Morton order. So the order
// depends on the tree alone.
//
//   const LeafOrder order(tree);
//   for (const std::uint32_t other : order.conflicts(leaf))
//     if (order.before(other, leaf)) graph.add_dependency(other, leaf);
//
// Thread-safety: immutable once built.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/schedule/quadtree.h"

namespace weft {

class LeafOrder {
 public:
  LeafOrder() = default;
  explicit LeafOrder(const Quadtree& tree);

  std::uint32_t size() const { return static_cast<std::uint32_t>(conflicts_.size()); }
  // Those in conflict with `leaf`, in order.
  const std::vector<std::uint32_t>& conflicts(std::uint32_t leaf) const { return conflicts_[leaf]; }
  bool in_conflict(std::uint32_t leaf, std::uint32_t other) const;
  // Whether `leaf` comes before `other` within a round. REQUIRES: they are in conflict.
  bool before(std::uint32_t leaf, std::uint32_t other) const {
    return colours_[leaf] < colours_[other];
  }

  std::size_t bytes() const;

 private:
  std::vector<std::vector<std::uint32_t>> conflicts_;
  std::vector<std::uint32_t> colours_;
};

}  // namespace weft
