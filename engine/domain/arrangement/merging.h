// SPDX-License-Identifier: Apache-2.0
// Merges features nearer than the tolerance (tolerance.h), and reports what moved.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "engine/base/geometry.h"
#include "engine/domain/pslg.h"
#include "engine/domain/stop_poller.h"

namespace weft {

struct Merging {
  double tolerance = 0;  // the larger of Pslg::snap and the floor of double precision
  // Input points that moved onto the vertex of another point; coincident points are not counted.
  std::uint64_t points = 0;
  // Input segments that are led through a vertex that is farther off them than rounding explains
  // (4 units in the last place of the largest coordinate).
  std::uint64_t segments = 0;
  // The largest distance of such a point to its vertex, or of such a vertex to its segment. If
  // several segments have become one edge, the distance is that to the lowest of them.
  double farthest = 0;
  Point farthest_at{};  // the vertex
  // Faces that merging closed. Segments that are apart in the input and now lie on each other close
  // what was between them: each connected run of such edges counts once. Segments that overlap
  // exactly in the input do not count. Each loop of segments that has become one vertex counts,
  // too.
  std::uint64_t vanished_faces = 0;
  Point vanished_at{};  // the vertex of the first loop, or an end of the first run

  void add_move(double distance, Point vertex) {
    if (distance <= farthest) return;
    farthest = distance;
    farthest_at = vertex;
  }
};

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
