// SPDX-License-Identifier: Apache-2.0
#include "checker/geometry/box_tree.h"

#include <algorithm>
#include <numeric>

namespace weft::check {

void Box::add(const Box& o) {
  min_x = std::min(min_x, o.min_x);
  min_y = std::min(min_y, o.min_y);
  max_x = std::max(max_x, o.max_x);
  max_y = std::max(max_y, o.max_y);
}

Box box_of(Vec2 p, Vec2 q) {
  return {std::min(p.x, q.x), std::min(p.y, q.y), std::max(p.x, q.x), std::max(p.y, q.y)};
}

BoxTree::BoxTree(std::vector<Box> boxes, std::vector<double> floors)
    : boxes_(std::move(boxes)), order_(boxes_.size()), floors_(std::move(floors)) {
  std::iota(order_.begin(), order_.end(), 0u);
  if (order_.empty()) return;
  nodes_.reserve(order_.size());
  build(0, static_cast<std::uint32_t>(order_.size()));
  if (floors_.empty()) return;
  node_floors_.resize(nodes_.size());
  for (auto at = static_cast<std::uint32_t>(nodes_.size()); at-- > 0;) {  // children come later
    const Node& node = nodes_[at];
    double& least = node_floors_[at];
    if (node.right != 0) {
      least = std::min(node_floors_[at + 1], node_floors_[node.right]);
    } else {
      least = floors_[order_[node.begin]];
      for (std::uint32_t k = node.begin; k < node.end; ++k)
        least = std::min(least, floors_[order_[k]]);
    }
  }
}

std::uint32_t BoxTree::build(std::uint32_t begin, std::uint32_t end) {
  Box box = boxes_[order_[begin]];
  for (std::uint32_t k = begin + 1; k < end; ++k) box.add(boxes_[order_[k]]);
  const auto at = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({box, begin, end, 0});
  if (end - begin <= kLeaf) return at;
  const bool by_x = box.max_x - box.min_x >= box.max_y - box.min_y;
  const auto centre = [&](std::uint32_t i) {
    const Box& b = boxes_[i];
    return by_x ? 0.5 * b.min_x + 0.5 * b.max_x : 0.5 * b.min_y + 0.5 * b.max_y;
  };
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::uint32_t i, std::uint32_t j) { return centre(i) < centre(j); });
  build(begin, middle);
  const std::uint32_t right = build(middle, end);
  nodes_[at].right = right;
  return at;
}

}  // namespace weft::check
