// SPDX-License-Identifier: Apache-2.0
// A hierarchy of bounding boxes over a fixed set of boxes, which finds those that meet a given one,
// and the one of the least cost. Halved at the median, so that clusters and outliers do no harm.
// Thread-safe after construction.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
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
  // To its nearest point.
  double distance(Vec2 p) const {
    const double dx = std::max({min_x - p.x, 0.0, p.x - max_x});
    const double dy = std::max({min_y - p.y, 0.0, p.y - max_y});
    return std::sqrt(dx * dx + dy * dy);
  }
  Box grown(double by) const { return {min_x - by, min_y - by, max_x + by, max_y + by}; }
};

Box box_of(Vec2 p, Vec2 q);

class BoxTree {
 public:
  // `floors`: one per box, or empty: all 0 (least).
  explicit BoxTree(std::vector<Box> boxes, std::vector<double> floors = {});

  // Calls visit(i) for every box i that meets `query`, those far to the right first. `visit` may
  // shrink `query`: boxes that no longer meet it are skipped.
  template <class Visit>
  void visit(const Box& query, Visit&& visit) const;

  // The box i with the least cost(i), if that is below `below`, which becomes that cost. REQUIRES:
  // cost(i) is at least its floor + rate * the distance from p to it, but for rounding; rate >= 0.
  template <class Cost>
  std::optional<std::uint32_t> least(Vec2 p, double rate, double& below, Cost&& cost) const;

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
  std::vector<double> floors_;
  std::vector<double> node_floors_;  // the least below each node
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

template <class Cost>
std::optional<std::uint32_t> BoxTree::least(Vec2 p, double rate, double& below, Cost&& cost) const {
  std::optional<std::uint32_t> found;
  if (nodes_.empty()) return found;
  const auto bound = [&](std::uint32_t at) {
    return (floors_.empty() ? 0 : node_floors_[at]) + rate * nodes_[at].box.distance(p);
  };
  struct Waiting {
    std::uint32_t at;
    double bound;
  };
  std::array<Waiting, 64> stack;  // as in visit
  std::size_t depth = 0;
  stack[depth++] = {0, bound(0)};
  while (depth > 0) {
    const Waiting next = stack[--depth];
    if (!(next.bound < below)) continue;
    const Node& node = nodes_[next.at];
    if (node.right != 0) {
      Waiting near{next.at + 1, bound(next.at + 1)};
      Waiting far{node.right, bound(node.right)};
      if (far.bound < near.bound) std::swap(near, far);
      stack[depth++] = far;
      stack[depth++] = near;
      continue;
    }
    for (std::uint32_t k = node.begin; k < node.end; ++k) {
      const std::uint32_t i = order_[k];
      const double floor = floors_.empty() ? 0 : floors_[i];
      if (!(floor + rate * boxes_[i].distance(p) < below)) continue;
      if (const double c = cost(i); c < below) {
        below = c;
        found = i;
      }
    }
  }
  return found;
}

}  // namespace weft::check
