// SPDX-License-Identifier: Apache-2.0
// Merges features nearer than the tolerance (tolerance.h), and reports what moved.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "engine/base/geometry.h"
#include "engine/domain/stop_poller.h"
#include "weft/mesh.h"
#include "weft/pslg.h"

namespace weft {

inline void add_move(Merging& merging, double distance, Point vertex) {
  if (distance <= merging.farthest) return;
  merging.farthest = distance;
  merging.farthest_at = vertex;
}

// Returns the points after merging. A point moves to the nearest point of a lower index that did
// not move itself and is nearer than merging.tolerance, if there is one. So points that did not
// move are the tolerance apart, and a long row of points, each near the next, does not collapse
// into one. Counts moved points in `merging`. Throws Stopped.
std::vector<Point> merge_points(const std::vector<Point>& points, Merging& merging,
                                StopPoller& poller);

// The number of connected components of the graph with these edges, and of the independent loops
// in it; edges are named by their ends.
using Edges = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
struct Connectivity {
  std::uint64_t components = 0;
  std::uint64_t loops = 0;
  std::size_t first_loop = 0;  // index of the edge that closes the first loop
};
Connectivity connectivity(const Edges& edges, StopPoller& poller);

}  // namespace weft
