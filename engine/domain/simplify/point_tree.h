// SPDX-License-Identifier: Apache-2.0
// Finds those of many points that lie in a box, while points are taken away: a tree of boxes over
// the points along a Hilbert curve.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/base/geometry.h"
#include "engine/domain/stop_poller.h"

namespace weft {

class PointTree {
 public:
  // Holds those of the points that `holds` names. REQUIRES: `points` outlives the tree. Throws
  // Stopped.
  PointTree(const std::vector<Point>& points, const std::vector<bool>& holds, StopPoller& poller);

  // REQUIRES: the tree holds it.
  void remove(std::uint32_t point);

  // Calls visit(index) for the points in the box, until one returns false. Returns whether none
  // did.
  template <class Visit>
  bool for_each_in(const Box& box, Visit&& visit) const {
    return count_.empty() || visit_node(1, box, visit);
  }

 private:
  static constexpr std::size_t kLeaf = 8;  // points

  template <class Visit>
  bool visit_node(std::size_t node, const Box& box, Visit& visit) const {
    const Box& own = box_[node];
    if (count_[node] == 0 || own.min_x > box.max_x || own.max_x < box.min_x ||
        own.min_y > box.max_y || own.max_y < box.min_y)
      return true;
    if (node < leaves_)
      return visit_node(2 * node, box, visit) && visit_node(2 * node + 1, box, visit);
    const std::size_t first = (node - leaves_) * kLeaf;
    for (std::size_t i = first; i < first + kLeaf && i < order_.size(); ++i) {
      if (!is_held_[i]) continue;
      const Point p = points_[order_[i]];
      if (p.x < box.min_x || p.x > box.max_x || p.y < box.min_y || p.y > box.max_y) continue;
      if (!visit(order_[i])) return false;
    }
    return true;
  }

  const std::vector<Point>& points_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> place_;  // per point: where it is in `order_`
  std::vector<bool> is_held_;         // by place
  std::size_t leaves_ = 1;            // a power of two; the leaves are the nodes from there on
  std::vector<Box> box_;              // per node; the root is 1, its children 2 and 3
  std::vector<std::uint32_t> count_;  // per node: of the points that it holds
};

}  // namespace weft
