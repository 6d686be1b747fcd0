// SPDX-License-Identifier: Apache-2.0
// Finds vertices beside a constrained edge that are nearer to it than a given height.
#pragma once

#include <cstdint>
#include <functional>
#include <unordered_set>
#include <vector>

#include "engine/domain/stop_poller.h"
#include "engine/domain/triangulation/triangulation.h"

namespace weft {

class StripSearch {
 public:
  using Vertex = Triangulation::Vertex;
  using Edge = Triangulation::Edge;

  // REQUIRES: the vertices are at least 2 * height apart.
  StripSearch(const Triangulation& triangulation, double height, StopPoller& poller)
      : t_(triangulation), height_(height), poller_(poller) {}

  // The vertices are so far apart from now on. REQUIRES: spacing >= 2 * height.
  void set_spacing(double spacing) {
    constexpr double kWide = 40;  // heights
    clear_part_ = spacing >= kWide * height_ ? kAlmostFlat : kAt120;
  }

  // Returns the vertex nearest to the edge among those on the side of edge.face that are nearer
  // than the height, between the edge's ends, not hidden by another constrained edge, and asked
  // for; kInfinite if there is none.
  //
  // It searches the faces that the strip of this height passes through; around the edge's ends,
  // those within 30 degrees of the edge. Throws Stopped.
  Vertex nearest(Edge edge, const std::function<bool(Vertex)>& is_asked_for);

  // Whether the face proves that there is no such vertex, as most faces do. If the face's apex sees
  // the edge at an angle of at most 120 degrees, so does every visible vertex, because it lies
  // outside the face's circumcircle. Then one of the angles at the edge is at least 30 degrees, at
  // an end that is at least twice the height away.
  //
  // A larger angle suffices if vertices are farther apart: if they are 40 heights apart, 171
  // degrees at the apex leave 4.5 at the edge, whose sine is above 3 in 40. So the apex is at least
  // 3 heights off, too.
  bool is_clear(Edge edge) const {
    const Vertex apex = t_.apex(edge);
    if (apex == Triangulation::kInfinite) return true;
    const Point u = t_.at(t_.right(edge)), v = t_.at(t_.left(edge)), at = t_.at(apex);
    return is_clear({u.x - at.x, u.y - at.y}, {v.x - at.x, v.y - at.y});
  }
  // Whether that holds for all edges of the face that carry a constraint. There is no branch on
  // which edges do, because it would be mispredicted.
  bool is_clear(std::uint32_t face) const {
    if (t_.is_infinite(face)) return true;
    const Point a = t_.at(t_.vertex(face, 0)), b = t_.at(t_.vertex(face, 1)),
                c = t_.at(t_.vertex(face, 2));
    const Point ab{b.x - a.x, b.y - a.y}, bc{c.x - b.x, c.y - b.y}, ca{a.x - c.x, a.y - c.y};
    const bool at_a = is_clear({-ca.x, -ca.y}, ab), free_a = t_.constraint({face, 0}) == kNone;
    const bool at_b = is_clear({-ab.x, -ab.y}, bc), free_b = t_.constraint({face, 1}) == kNone;
    const bool at_c = is_clear({-bc.x, -bc.y}, ca), free_c = t_.constraint({face, 2}) == kNone;
    return (at_a | free_a) & (at_b | free_b) & (at_c | free_c);
  }

 private:
  // Squared cosines of 120 degrees and of 171.
  static constexpr double kAt120 = 0.25;
  static constexpr double kAlmostFlat = 0.975;

  // For the edge that an apex sees between u and v.
  bool is_clear(Point u, Point v) const {
    const double dot = u.x * v.x + u.y * v.y;
    const bool is_steep = dot >= 0;
    return is_steep |
           (dot * dot < clear_part_ * ((u.x * u.x + u.y * u.y) * (v.x * v.x + v.y * v.y)));
  }

  // A vertex in the coordinates of the edge: along it, and above it, both times its length.
  struct Place {
    double along, above;
  };
  Place place(Vertex v) const;
  bool is_low(Place p) const;
  bool leads_on(Edge edge) const;

  const Triangulation& t_;
  const double height_;
  StopPoller& poller_;
  double clear_part_ = kAt120;
  Vertex u_ = 0, v_ = 0;  // the ends, and what is known of the edge
  Point from_, along_;
  double length_ = 0, length2_ = 0;
  std::vector<Edge> stack_;  // edges to look across, each from its face
  std::unordered_set<std::uint32_t> seen_;
};

}  // namespace weft
