// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/simplify/point_tree.h"

#include "engine/domain/triangulation/hilbert.h"

namespace weft {

PointTree::PointTree(const std::vector<Point>& points, const std::vector<bool>& holds,
                     StopPoller& poller)
    : points_(points), place_(points.size(), kNone) {
  std::vector<Point> held;
  std::vector<std::uint32_t> index;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (!holds[i]) continue;
    held.push_back(points[i]);
    index.push_back(i);
  }
  if (held.empty()) return;
  order_ = hilbert_order(held, poller);
  for (std::uint32_t place = 0; place < order_.size(); ++place) {
    order_[place] = index[order_[place]];
    place_[order_[place]] = place;
  }
  is_held_.assign(order_.size(), true);
  while (leaves_ * kLeaf < order_.size()) leaves_ *= 2;
  box_.resize(2 * leaves_);
  count_.resize(2 * leaves_, 0);
  for (std::size_t place = 0; place < order_.size(); ++place) {
    const std::size_t leaf = leaves_ + place / kLeaf;
    box_[leaf].add(points[order_[place]]);
    ++count_[leaf];
  }
  for (std::size_t node = leaves_ - 1; node > 0; --node) {
    for (const std::size_t child : {2 * node, 2 * node + 1}) {
      if (count_[child] == 0) continue;
      box_[node].merge(box_[child]);
      count_[node] += count_[child];
    }
  }
}

void PointTree::remove(std::uint32_t point) {
  const std::uint32_t place = place_[point];
  is_held_[place] = false;
  for (std::size_t node = leaves_ + place / kLeaf; node > 0; node /= 2) --count_[node];
}

}  // namespace weft
