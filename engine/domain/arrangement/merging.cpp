// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/arrangement/merging.h"

#include <algorithm>
#include <numeric>

#include "engine/domain/arrangement/point_grid.h"
#include "engine/domain/arrangement/snapping.h"

namespace weft {

std::vector<Point> merge_points(const std::vector<Point>& points, Merging& merging,
                                StopPoller& poller) {
  PointGrid kept(merging.tolerance);
  std::vector<Point> merged = points;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    poller.step();
    const std::uint32_t near = kept.nearest(points[i]);
    if (near == kNone) {
      kept.insert(i, points[i]);
      continue;
    }
    merged[i] = points[near];
    if (points[i] == points[near]) continue;
    ++merging.points;
    add_move(merging, distance(points[i], points[near]), points[near]);
  }
  return merged;
}

Connectivity connectivity(const Edges& edges, StopPoller& poller) {
  std::vector<std::uint32_t> nodes;
  nodes.reserve(2 * edges.size());
  for (const auto& [a, b] : edges) nodes.insert(nodes.end(), {a, b});
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  std::vector<std::size_t> parent(nodes.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](std::uint32_t node) {
    auto i = static_cast<std::size_t>(std::lower_bound(nodes.begin(), nodes.end(), node) -
                                      nodes.begin());
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  Connectivity result{.components = nodes.size()};
  for (std::size_t e = 0; e < edges.size(); ++e) {
    poller.step();
    const std::size_t a = root(edges[e].first), b = root(edges[e].second);
    if (a != b) {
      parent[std::max(a, b)] = std::min(a, b);
      --result.components;
    } else if (result.loops++ == 0) {
      result.first_loop = e;
    }
  }
  return result;
}

}  // namespace weft
