// SPDX-License-Identifier: Apache-2.0
// Finds vertices beside a constrained edge that are nearer to it than a given height.
#pragma once

#include <cstdint>
#include <unordered_set>
#include <vector>

#include "engine/domain/pacer.h"
#include "engine/domain/triangulation.h"

namespace weft {

class StripSearch {
 public:
  using Vertex = Triangulation::Vertex;
  using Edge = Triangulation::Edge;

  // The vertices are at least 2 * height apart.
  StripSearch(const Triangulation& triangulation, double height, Pacer& pacer)
      : t_(triangulation), height_(height), pacer_(pacer) {}

  // Of the vertices on the side of edge.face, the one nearest to the edge: nearer than the height,
  // between the edge's ends, and not hidden by another constrained edge. kInfinite if there is
  // none. So the triangle that it makes with the edge has no vertex inside.
  //
  // It searches the faces that the strip of this height passes through; around the edge's ends,
  // those within 30 degrees of it. Throws Stopped.
  Vertex nearest(Edge edge);

  // Whether the face tells that there is none, as most do: it is seen from its apex at 120 degrees
  // at most, so every visible vertex sees the edge so, since it lies outside of the face's
  // circumcircle. Then one of the angles at the edge is 30 degrees at least, at an end that is
  // twice the height away.
  bool is_clear(Edge edge) const {
    const Vertex apex = t_.apex(edge);
    if (apex == Triangulation::kInfinite) return true;
    const Point u = t_.at(t_.right(edge)), v = t_.at(t_.left(edge)), at = t_.at(apex);
    const double ux = u.x - at.x, uy = u.y - at.y, vx = v.x - at.x, vy = v.y - at.y;
    const double dot = ux * vx + uy * vy;
    return dot >= 0 || 4 * dot * dot < (ux * ux + uy * uy) * (vx * vx + vy * vy);
  }

 private:
  // A vertex in the coordinates of the edge: along it, and above it, both times its length.
  struct Place {
    double along, above;
  };
  Place place(Vertex v) const;
  bool is_low(Place p) const;
  bool leads_on(Edge edge) const;

  const Triangulation& t_;
  const double height_;
  Pacer& pacer_;
  Vertex u_ = 0, v_ = 0;  // the ends, and what is known of the edge
  Point from_, along_;
  double length_ = 0, length2_ = 0;
  std::vector<Edge> stack_;  // to look across, from the face that it names
  std::unordered_set<std::uint32_t> seen_;
};

}  // namespace weft
