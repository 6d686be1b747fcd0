// SPDX-License-Identifier: Apache-2.0
// A hierarchy of bounding boxes over a fixed set of boxes, which finds those that meet a given one.
// Halved at the median, so that clusters and outliers do no harm. Thread-safe after construction.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "checker/domain.h"

namespace weft::check {

// Closed, axis-parallel.
struct Box {
  double min_x = 0;
  double min_y = 0;
  double max_x = 0;
  double max_y = 0;

  bool meets(const Box& o) const {
    return min_x <= o.max_x && o.min_x <= max_x && min_y <= o.max_y && o.min_y <= max_y;
  }
  void add(const Box& o);
  Box grown(double by) const { return {min_x - by, min_y - by, max_x + by, max_y + by}; }
};

Box box_of(Vec2 p, Vec2 q);

class BoxTree {
 public:
  explicit BoxTree(std::vector<Box> boxes);

  // Calls visit(i) for every box i that meets `query`, those far to the right first. `visit` may
  // shrink `query`: boxes that no longer meet it are skipped.
  template <class Visit>
  void visit(const Box& query, Visit&& visit) const;

 private:
  static constexpr std::uint32_t kLeaf = 6;  // maximum boxes per leaf

  struct Node {
    Box box;
    std::uint32_t begin, end;  // in order_
    std::uint32_t right;       // right child; the left one follows this node; 0 for a leaf
  };
  std::uint32_t build(std::uint32_t begin, std::uint32_t end);

  std::vector<Box> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

template <class Visit>
void BoxTree::visit(const Box& query, Visit&& visit) const {
  if (nodes_.empty()) return;
  // Halving 2^32 boxes takes 32 levels; each leaves at most one node waiting.
  std::array<std::uint32_t, 64> stack;
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t at = stack[--depth];
    const Node& node = nodes_[at];
    if (!node.box.meets(query)) continue;
    if (node.right != 0) {
      stack[depth++] = at + 1;
      stack[depth++] = node.right;
      continue;
    }
    for (std::uint32_t k = node.begin; k < node.end; ++k)
      if (boxes_[order_[k]].meets(query)) visit(order_[k]);
  }
}

}  // namespace weft::check
