// SPDX-License-Identifier: Apache-2.0
// What became of features nearer than the tolerance (tolerance.h).
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
  // Input points that lie on the vertex of another one now; coincident points are not counted.
  std::uint64_t points = 0;
  // Input segments that are led through a vertex which is not on them, by more than rounding
  // explains (4 units in the last place of the largest coordinate).
  std::uint64_t segments = 0;
  // The largest distance of such a point to its vertex, and of such a vertex to its segment. Where
  // several segments have become one edge, the distance is that to the lowest of them.
  double farthest = 0;
  Point farthest_at{};  // the vertex
  // Places where the input keeps segments apart that lie on each other now, so that what was
  // between them is gone: each connected run of such edges counts once. Segments that overlap in
  // the input, on one line exactly, do not count. And loops of segments that have become one
  // vertex: each counts.
  std::uint64_t vanished_faces = 0;
  Point vanished_at{};  // the vertex of the first loop, or an end of the first run

  void add_move(double distance, Point vertex) {
    if (distance <= farthest) return;
    farthest = distance;
    farthest_at = vertex;
  }
};

// The points, each at its own place or at that of the nearest lower one that keeps its place and is
// nearer than merging.tolerance. So the points that keep their places are the tolerance apart, and
// a long row of points, each near the next, does not collapse into one. Counts them in `merging`.
// Throws Stopped.
std::vector<Point> merge_points(const std::vector<Point>& points, Merging& merging,
                                StopPoller& poller);

// The number of connected components of the graph with these edges, and of the independent loops
// in it; edges are named by their ends.
using Edges = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
struct Connectivity {
  std::uint64_t components = 0;
  std::uint64_t loops = 0;
  std::size_t first_loop = 0;  // the edge that closes the first
};
Connectivity connectivity(const Edges& edges, StopPoller& poller);

}  // namespace weft
