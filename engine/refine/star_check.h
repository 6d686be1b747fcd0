// SPDX-License-Identifier: Apache-2.0
// Whether the star of a point on a segment is Delaunay.
//
// The point that splits a segment is rounded, so it lies beside the segment, by a unit in the last
// place or so. Bowyer-Watson's lemma, that a cavity and the star of its point are Delaunay, holds
// for points in the cavity alone. If the circumcircle of a triangle at the segment is so large that
// its arc beyond the segment is flatter than that unit, a point beyond the segment may lie outside
// the circle, and the star is no Delaunay triangulation. That happens where a segment is split
// beside a wedge of 1e-8 radians; nowhere else was it seen.
//
// Whether the edge from p to a point b of the ring is locally Delaunay, between the points a and c
// of the ring, is the sign of
//     |a|^2 (b x c) - |b|^2 (a x c) + |c|^2 (a x b),
// all relative to p: at least 0 if p is not outside the circle through a, b, c. The rounding error
// is that of the in-circle test in cavity.h.
#pragma once

#include <algorithm>
#include <cstdint>

#include "engine/domain/predicates.h"
#include "engine/refine/cavity.h"
#include "engine/refine/mesh.h"

namespace weft {

// Of the star of p over the ring's edges first <= i < last. REQUIRES: its triangles turn left.
inline bool star_is_delaunay(const Mesh& mesh, const Ring& ring, std::uint32_t first,
                             std::uint32_t last, Point p) {
  for (std::uint32_t i = first + 1; i < last; ++i) {
    const RingPoint& a = ring.points[i - 1];
    const RingPoint& b = ring.points[i];
    const RingPoint& c = ring.points[i + 1];
    const double determinant =
        a.length2 * c.cross - b.length2 * (a.x * c.y - a.y * c.x) + c.length2 * b.cross;
    const double error =
        kInCircleError * (a.length2 * c.length2 + (a.length2 + c.length2) * b.length2);
    if (determinant > error) continue;
    // The triangle p, a, b turns left, whatever a, b, c do.
    if (determinant < -error || in_circle_exact(p, mesh.vertices[a.vertex], mesh.vertices[b.vertex],
                                                mesh.vertices[c.vertex])) {
      return false;
    }
  }
  return true;
}

}  // namespace weft
