// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/cover.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <set>

#include "engine/base/vector.h"
#include "engine/domain/arcs/arc.h"
#include "engine/domain/arcs/flat_arcs.h"

namespace weft {
namespace {

// A part of the tour: across a constrained edge, and into `face`, or back to one that it has seen.
struct Move {
  std::uint32_t constraint;
  std::uint32_t face;  // kNone on the way back
};

std::vector<Move> tour(const Faces& faces, const FaceGraph& graph, StopPoller& poller) {
  struct Stop {
    std::uint32_t face;
    std::uint32_t constraint;  // through which the tour came
    std::size_t next = 0;      // of the face's steps
  };
  std::vector<Move> moves;
  moves.reserve(2 * faces.count);
  std::vector<bool> seen(faces.count, false);
  std::vector<Stop> way{{Faces::kUnbounded, kNone}};
  seen[Faces::kUnbounded] = true;
  while (!way.empty()) {
    poller.step();
    Stop& here = way.back();
    const auto steps = graph.from(here.face);
    while (here.next < steps.size() && seen[steps[here.next].to]) ++here.next;
    if (here.next == steps.size()) {
      if (here.constraint != kNone) moves.push_back({here.constraint, kNone});
      way.pop_back();
      continue;
    }
    const FaceGraph::Step& step = steps[here.next];
    seen[step.to] = true;
    moves.push_back({step.constraint, step.to});
    way.push_back({step.to, step.constraint});
  }
  return moves;
}

// Calls visit(area) for each in the list of areas on a constrained edge.
template <class F>
void for_each_area(const Arrangement& a, std::size_t areas, std::uint32_t list,
                   std::vector<std::uint32_t>& open, StopPoller& poller, F&& visit) {
  if (list == kNone) return;
  open.push_back(list);
  while (!open.empty()) {
    poller.step();
    const std::uint32_t at = open.back();
    open.pop_back();
    if (at < areas) {
      visit(at);
    } else {
      const Arrangement::AreaJoin& join = a.area_joins[at - areas];
      open.push_back(join.second);
      open.push_back(join.first);
    }
  }
}

// Twice what lies between an edge, of which the triangle is on the left, and the arc whose chord it
// is: above 0 if that is part of the triangle's face.
class BesideChords {
 public:
  BesideChords(const Arrangement& a, const Pslg& pslg)
      : a_(a), pslg_(pslg), bulges_(pslg.arcs.empty() ? std::vector<double>() : bulges_of(pslg)) {}

  double operator()(const Arrangement::Triangle& triangle, int edge) const {
    if (bulges_.empty() || triangle.constraint[edge] == kNone) return 0;
    const std::uint32_t piece = a_.constraints[triangle.constraint[edge]].segment;
    if (bulges_[piece] == 0) return 0;
    const Point p = a_.vertices[triangle.vertex[(edge + 1) % 3]];
    const Point q = a_.vertices[triangle.vertex[(edge + 2) % 3]];
    const Point from = pslg_.points[pslg_.segments[piece].a];
    const Point to = pslg_.points[pslg_.segments[piece].b];
    return 2 *
           area_beside_chord(p, q, dot(q - p, to - from) > 0 ? bulges_[piece] : -bulges_[piece]);
  }

 private:
  const Arrangement& a_;
  const Pslg& pslg_;
  const std::vector<double> bulges_;  // empty: all are straight
};

// Twice the areas.
std::vector<double> sizes_of_faces(const Arrangement& a, const Faces& faces, const Pslg& pslg,
                                   StopPoller& poller) {
  const BesideChords beside_chord(a, pslg);
  std::vector<double> sizes(faces.count, 0.0);
  for (std::size_t t = 0; t < a.triangles.size(); ++t) {
    poller.step();
    const auto& v = a.triangles[t].vertex;
    const Point p = a.vertices[v[0]], q = a.vertices[v[1]], r = a.vertices[v[2]];
    double& size = sizes[faces.of_triangle[t]];
    size += (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
    for (int edge = 0; edge < 3; ++edge) size += beside_chord(a.triangles[t], edge);
  }
  return sizes;
}

// Sizes that only rounding tells apart are one size. To 30 bits.
double without_rounding(double size) {
  int exponent = 0;
  const double mantissa = std::frexp(size, &exponent);
  return std::ldexp(std::nearbyint(std::ldexp(mantissa, 30)), exponent - 30);
}

// Per area its place in the order of `less`.
template <class Less>
std::vector<std::uint32_t> ranks(std::size_t count, Less&& less) {
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), less);
  std::vector<std::uint32_t> rank(count);
  for (std::uint32_t i = 0; i < count; ++i) rank[order[i]] = i;
  return rank;
}

}  // namespace

Covers cover_faces(const Arrangement& arrangement, const Faces& faces, const FaceGraph& graph,
                   const Pslg& pslg, StopPoller& poller) {
  const std::vector<Area>& areas = pslg.areas;
  const std::vector<Move> moves = tour(faces, graph, poller);
  std::vector<std::uint32_t> open;
  const auto cross = [&](const Move& move, auto&& visit) {
    for_each_area(arrangement, areas.size(), arrangement.constraints[move.constraint].areas, open,
                  poller, visit);
  };

  // An area's size is what the tour has seen when it leaves, less what it had seen when it entered.
  std::vector<bool> covers(areas.size(), false);
  std::vector<double> size(areas.size(), 0.0);
  const std::vector<double> size_of_face = sizes_of_faces(arrangement, faces, pslg, poller);
  double seen = 0;
  for (const Move& move : moves) {
    cross(move, [&](std::uint32_t area) {
      size[area] += covers[area] ? seen : -seen;
      covers[area] = !covers[area];
    });
    if (move.face != kNone) seen += size_of_face[move.face];
  }
  for (double& each : size) each = without_rounding(each);

  const std::vector<std::uint32_t> by_region =
      ranks(areas.size(), [&](std::uint32_t a, std::uint32_t b) {
        if (areas[a].priority != areas[b].priority) return areas[a].priority > areas[b].priority;
        return size[a] < size[b];
      });
  const std::vector<std::uint32_t> by_bound =
      ranks(areas.size(), [&](std::uint32_t a, std::uint32_t b) {
        return areas[a].max_area.value_or(0) < areas[b].max_area.value_or(0);
      });

  Covers result{.of_face = std::vector<Cover>(faces.count), .overlap = {}};
  std::uint32_t count = 0, holes = 0;
  std::set<std::pair<std::uint32_t, std::uint32_t>> regions,
      bounds;                     // rank and area, of those that cover
  std::set<std::uint32_t> alone;  // those that cover and have not shared a face yet
  std::vector<bool> shares(areas.size(), false);
  const auto toggle = [](auto& set, const auto& value, bool in) {
    if (in)
      set.insert(value);
    else
      set.erase(value);
  };
  for (const Move& move : moves) {
    cross(move, [&](std::uint32_t area) {
      const bool in = !covers[area];
      covers[area] = in;
      std::uint32_t& number = areas[area].is_hole ? holes : count;
      number += in ? 1 : -1u;
      if (areas[area].is_hole) return;
      if (!shares[area]) toggle(alone, area, in);
      if (areas[area].region) toggle(regions, std::pair(by_region[area], area), in);
      if (areas[area].max_area) toggle(bounds, std::pair(by_bound[area], area), in);
    });
    if (move.face == kNone) continue;
    Cover& cover = result.of_face[move.face];
    cover.areas = count;
    cover.is_hole = holes > 0;
    if (!regions.empty()) cover.region = areas[regions.begin()->second].region;
    if (!bounds.empty()) cover.max_area = areas[bounds.begin()->second].max_area;
    if (count < 2) continue;
    result.overlap.area += size_of_face[move.face] / 2;
    result.overlap.areas += alone.size();
    for (const std::uint32_t area : alone) shares[area] = true;
    alone.clear();
  }
  return result;
}

}  // namespace weft
