// SPDX-License-Identifier: Apache-2.0
// The lines of a domain without its triangles: what bounds it, divides its regions or lies in it,
// each line with the regions on its two sides. Simplification changes it, and the domain is made of
// it again.
//
// Laws between two steps (checked by tests): lines meet in points only; the regions beside the
// lines around a face agree; all coordinates of points that lines name are those of the original
// domain's vertices, or lie on its lines up to rounding.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "engine/base/geometry.h"
#include "engine/domain/arrangement/arrangement.h"
#include "engine/domain/domain.h"
#include "engine/domain/stop_poller.h"

namespace weft {

// The area of an equilateral triangle with edges of 1.
inline constexpr double kFinestTriangle = 0.4330127018922193;

struct GraphLine {
  std::uint32_t a = 0;  // index into LineGraph::points
  std::uint32_t b = 0;
  std::uint32_t left = kNone;  // the region on the left from a to b; kNone is outside
  std::uint32_t right = kNone;
  std::int32_t marker = 0;
  std::uint32_t segment = 0;  // of the PSLG
  // No point of the line is farther than this from the original lines with its marker.
  double error = 0;

  bool bounds_domain() const { return (left == kNone) != (right == kNone); }
};

struct LineGraph {
  std::vector<Point> points;            // those of the original domain first; two may coincide
  std::vector<std::uint32_t> original;  // per point: the vertex of the domain, kNone if it is new
  std::vector<double> error;            // per point, as of a line
  std::vector<double> finest;           // per point: how near features may be there; 0: as they are
  std::vector<bool> is_end;          // per point: where the original lines meet, or a marker ends
  std::vector<std::uint32_t> loose;  // points that no line names, but that stay
  std::vector<GraphLine> lines;

  // The index of a new point that is `error` from the original lines at most.
  std::uint32_t add_point(Point at, std::uint32_t vertex, double error, double finest);
};

// Per point: whether lines name it, or it is loose.
std::vector<bool> used_points(const LineGraph& graph);

// Per point: whether it shares its place with another one of those used.
std::vector<bool> find_twins(const LineGraph& graph, const std::vector<bool>& used);

// Leaves `finest` 0. Throws Stopped.
LineGraph line_graph_of(const Domain& domain, StopPoller& poller);

// The graph's lines triangulated, up to the convex hull. `arrangement` names lines as segments, and
// points as input points. `region` is kNone outside.
struct Sides {
  Arrangement arrangement;
  std::vector<std::uint32_t> region;  // per triangle
};
Sides triangulate_sides(const LineGraph& graph, StopPoller& poller);

// The domain of the graph; regions, and what was merged and overlaps, are those of the original.
// REQUIRES: it has lines that bound the domain. Throws Stopped.
Domain domain_of_lines(const LineGraph& graph, const Domain& original, StopPoller& poller);

}  // namespace weft
