// SPDX-License-Identifier: Apache-2.0
// The least of the cones of many sources (source_tree.h), evaluated fast: a quadtree whose leaves
// list the sources that may be the lowest somewhere in them.
//
// A list holds inner nodes of the source tree, too: if G times a node's diagonal is at most
// kTolerance of its cone, its cone stands for those below. Both trees are descended at
// the same time, as by J. Barnes and P. Hut, "A hierarchical O(N log N) force-calculation
// algorithm" (1986). A list leaves out what is above the size itself, so where the size is below
// its limit, it is empty.
//
// Outside the domain a leaf lists one source, because no more than a bound is asked for there.
// Deterministic at any number of threads. Immutable once built.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/base/context.h"
#include "engine/base/geometry.h"
#include "engine/domain/domain.h"
#include "engine/size/gradation/source_tree.h"
#include "engine/size/interval.h"
#include "engine/size/size_function.h"
#include "weft/error.h"

namespace weft {

class LimitTree {
 public:
  static constexpr int kMaxDepth = 48;
  // A tree that would be larger ends with nodes that stand for too much, so the limit is lower.
  static constexpr std::size_t kMaxNodes = std::size_t{1} << 20;
  static constexpr std::size_t kMaxListed = std::size_t{1} << 24;

  // Errors: those of the context.
  static Result<LimitTree> build(SourceTree sources, const SizeFunction& size, double gradation,
                                 const Domain& domain, const ExecutionContext& context);

  // No source anywhere.
  bool empty() const { return sources_.empty(); }

  // The limit to the length of edges at kLanes points; infinity if the size is below it. A point
  // outside the square around the domain has the limit of the nearest point of it.
  void evaluate(const double* x, const double* y, double* edge) const noexcept;

  // Bounds of the limit over a box, bit for bit.
  Interval bounds(const Box& box) const noexcept;

  std::size_t bytes() const {
    return sources_.bytes() + nodes_.capacity() * sizeof(Node) +
           lists_.capacity() * sizeof(lists_[0]);
  }
  const SourceTree& sources() const { return sources_; }
  std::size_t nodes() const { return nodes_.size(); }
  std::size_t listed() const { return lists_.size(); }

 private:
  friend class LimitTreeBuilder;

  struct Node {
    std::uint32_t first_child = 0;  // of four, in Morton order; 0 for a leaf
    std::uint32_t first = 0;        // of the list
    std::uint32_t count = 0;
    double lo = 0;  // bounds of the limit
    double hi = 0;
  };

  const Node& leaf(double x, double y) const noexcept;
  void add_bounds(const Node& node, const Box& at, const Box& box, Interval& found) const noexcept;

  SourceTree sources_;
  double gradation_ = 0;
  Box root_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> lists_;  // nodes of the source tree
};

}  // namespace weft
