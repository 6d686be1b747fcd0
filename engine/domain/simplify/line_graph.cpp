// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/simplify/line_graph.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "engine/domain/extract.h"
#include "engine/domain/face.h"
#include "engine/domain/faces.h"

namespace weft {
namespace {

// The graph as a PSLG: points in the order of the original, then new ones; segments are its lines,
// in their order. `point` gets the graph's point of
// each of the PSLG's.
Pslg pslg_of(const LineGraph& graph, std::vector<std::uint32_t>& point) {
  std::vector<std::uint32_t> number(graph.points.size(), kNone);
  for (const GraphLine& line : graph.lines) number[line.a] = number[line.b] = 0;
  for (const std::uint32_t v : graph.loose) number[v] = 0;
  Pslg pslg;
  for (std::uint32_t v = 0; v < number.size(); ++v)
    if (number[v] != kNone) point.push_back(v);
  std::stable_sort(point.begin(), point.end(), [&](std::uint32_t v, std::uint32_t w) {
    return graph.original[v] < graph.original[w];
  });
  for (const std::uint32_t v : point) {
    number[v] = static_cast<std::uint32_t>(pslg.points.size());
    pslg.points.push_back(graph.points[v]);
  }
  pslg.segments.reserve(graph.lines.size());
  for (const GraphLine& line : graph.lines)
    pslg.segments.push_back({.a = number[line.a], .b = number[line.b], .marker = line.marker});
  return pslg;
}

void find_ends(LineGraph& graph) {
  std::vector<std::uint32_t> count(graph.points.size(), 0);
  std::vector<std::int32_t> marker(graph.points.size(), 0);  // of the last line
  graph.is_end.assign(graph.points.size(), false);
  for (const GraphLine& line : graph.lines) {
    for (const std::uint32_t v : {line.a, line.b}) {
      if (count[v]++ > 0 && marker[v] != line.marker) graph.is_end[v] = true;
      marker[v] = line.marker;
    }
  }
  for (std::size_t v = 0; v < count.size(); ++v)
    if (count[v] != 2) graph.is_end[v] = true;
}

double along(Point a, Point b, Point p, Point q) {
  return (b.x - a.x) * (q.x - p.x) + (b.y - a.y) * (q.y - p.y);
}

// The region of each face, as the first line beside it says.
std::vector<std::uint32_t> regions_of_faces(const LineGraph& graph, const Arrangement& a,
                                            const Faces& faces, StopPoller& poller) {
  std::vector<std::uint32_t> region(faces.count, kNone);
  std::vector<bool> known(faces.count, false);
  known[Faces::kUnbounded] = true;
  for (std::size_t t = 0; t < a.triangles.size(); ++t) {
    poller.step();
    const std::uint32_t face = faces.of_triangle[t];
    if (known[face]) continue;
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t c = a.triangles[t].constraint[i];
      if (c == kNone) continue;
      const GraphLine& line = graph.lines[a.constraints[c].segment];
      const Point p = a.vertices[a.triangles[t].vertex[ccw(i)]];
      const Point q = a.vertices[a.triangles[t].vertex[cw(i)]];
      const bool forward = along(graph.points[line.a], graph.points[line.b], p, q) > 0;
      region[face] = forward ? line.left : line.right;
      known[face] = true;
      break;
    }
  }
  return region;
}

}  // namespace

std::vector<bool> used_points(const LineGraph& graph) {
  std::vector<bool> used(graph.points.size(), false);
  for (const GraphLine& line : graph.lines) used[line.a] = used[line.b] = true;
  for (const std::uint32_t v : graph.loose) used[v] = true;
  return used;
}

std::vector<bool> find_twins(const LineGraph& graph, const std::vector<bool>& used) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t v = 0; v < used.size(); ++v)
    if (used[v]) order.push_back(v);
  const auto& at = graph.points;
  std::sort(order.begin(), order.end(), [&](std::uint32_t v, std::uint32_t w) {
    return at[v].x != at[w].x ? at[v].x < at[w].x : at[v].y < at[w].y;
  });
  std::vector<bool> is_twin(graph.points.size(), false);
  for (std::size_t i = 1; i < order.size(); ++i)
    if (at[order[i - 1]] == at[order[i]]) is_twin[order[i - 1]] = is_twin[order[i]] = true;
  return is_twin;
}

std::uint32_t LineGraph::add_point(Point at, std::uint32_t vertex, double off, double fine) {
  points.push_back(at);
  original.push_back(vertex);
  error.push_back(off);
  finest.push_back(fine);
  is_end.push_back(false);
  return static_cast<std::uint32_t>(points.size() - 1);
}

LineGraph line_graph_of(const Domain& domain, StopPoller& poller) {
  LineGraph graph;
  graph.points = domain.vertices;
  graph.original.resize(graph.points.size());
  for (std::uint32_t v = 0; v < graph.original.size(); ++v) graph.original[v] = v;
  graph.error.resize(graph.points.size(), 0);
  graph.finest.resize(graph.points.size(), 0);
  std::vector<bool> is_on_line(graph.points.size(), false);
  graph.lines.reserve(domain.subsegments.size());
  for (std::uint32_t t = 0; t < domain.triangles.size(); ++t) {
    poller.step();
    const Domain::Triangle& triangle = domain.triangles[t];
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t n = triangle.neighbor[i];
      if (triangle.subsegment[i] == kNone || (n != kNone && n < t)) continue;
      const Subsegment& s = domain.subsegments[triangle.subsegment[i]];
      graph.lines.push_back({.a = triangle.vertex[ccw(i)],
                             .b = triangle.vertex[cw(i)],
                             .left = triangle.region,
                             .right = n == kNone ? kNone : domain.triangles[n].region,
                             .marker = s.marker,
                             .segment = s.segment});
      is_on_line[s.a] = is_on_line[s.b] = true;
    }
  }
  for (std::uint32_t v = 0; v < is_on_line.size(); ++v)
    if (!is_on_line[v]) graph.loose.push_back(v);
  find_ends(graph);
  return graph;
}

Sides triangulate_sides(const LineGraph& graph, StopPoller& poller) {
  std::vector<std::uint32_t> point;
  const Pslg pslg = pslg_of(graph, point);
  Sides sides{.arrangement = arrange(pslg, poller), .region = {}};
  Arrangement& a = sides.arrangement;
  for (std::uint32_t& v : a.input_point)
    if (v != kNone) v = point[v];
  const Faces faces = find_faces(a, poller);
  const std::vector<std::uint32_t> region = regions_of_faces(graph, a, faces, poller);
  sides.region.resize(a.triangles.size());
  for (std::size_t t = 0; t < sides.region.size(); ++t)
    sides.region[t] = region[faces.of_triangle[t]];
  return sides;
}

Domain domain_of_lines(const LineGraph& graph, const Domain& original, StopPoller& poller) {
  Sides sides = triangulate_sides(graph, poller);
  for (std::uint32_t& v : sides.arrangement.input_point) {
    if (v != kNone) v = graph.original[v];
    if (v != kNone) v = original.input_point[v];
  }
  for (Arrangement::Constraint& c : sides.arrangement.constraints)
    c.segment = graph.lines[c.segment].segment;
  Domain domain = extract(
      sides.arrangement,
      {.region = std::move(sides.region), .regions = original.regions, .overlap = original.overlap},
      poller);
  domain.merging = original.merging;
  return domain;
}

}  // namespace weft
