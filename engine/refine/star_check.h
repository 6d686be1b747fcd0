// SPDX-License-Identifier: Apache-2.0
// Checks for what rounding may spoil: stars that do not turn left, edges that are too thin to be
// split, points that an edge hides, and stars of points on segments that are not Delaunay.
//
// The point that splits a segment is rounded, so it lies beside the segment, by a unit in the last
// place or so. Bowyer-Watson's lemma, that a cavity and the star of its point are Delaunay, holds
// for points in the cavity alone. If the circumcircle of a triangle at the segment is so large that
// its arc beyond the segment is flatter than that unit, a point beyond the segment may lie outside
// the circle, and the star is not Delaunay. That was seen only if a segment is split beside a wedge
// of 1e-8 radians.
//
// Whether the edge from p to a point b of the ring is locally Delaunay, between the points a and c
// of the ring, is the sign of
//     |a|^2 (b x c) - |b|^2 (a x c) + |c|^2 (a x b),
// all relative to p: at least 0 if p is not outside the circle through a, b, c. The rounding error
// is that of the in-circle test in cavity.h.
//
// Thread-safety: pure functions of the ring and of what the task owns of the mesh.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/domain/triangulation/predicates.h"
#include "engine/refine/cavity.h"
#include "engine/refine/storage/mesh_store.h"

namespace weft {

// Whether the star of p over the ring's edges first <= i < last is Delaunay. REQUIRES: its
// triangles turn left.
inline bool star_is_delaunay(const MeshStore& mesh, const Ring& ring, std::uint32_t first,
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

// Whether all triangles of the star of p turn left, exactly.
inline bool star_turns_left(const MeshStore& mesh, const Ring& ring, Point p) {
  for (std::uint32_t i = 0; i < ring.size; ++i) {
    if (orientation_exact(p, mesh.vertices[ring.points[i].vertex],
                          mesh.vertices[ring.points[i + 1].vertex]) <= 0) {
      return false;
    }
  }
  return true;
}

// Whether the vertex opposite is too near to the edge for double precision, nearer than the root of
// `precision2`: two segments that almost coincide would split each other down to the floor. A
// vertex beyond the edge's ends does not count: if a split was rounded, the next piece of the
// same segment is on its line except for a unit in the last place.
inline bool too_thin(const MeshStore& mesh, HalfEdge h, double precision2) {
  const Triangle& triangle = mesh.triangles[triangle_of(h)];
  const Point apex = mesh.vertices[triangle.vertex[edge_of(h)]];
  const Point a = mesh.vertices[triangle.vertex[kNext[edge_of(h)]]];
  const Point b = mesh.vertices[triangle.vertex[kPrevious[edge_of(h)]]];
  const double x = b.x - a.x;
  const double y = b.y - a.y;
  const double length2 = x * x + y * y;
  const double along = x * (apex.x - a.x) + y * (apex.y - a.y);
  const double cross = x * (apex.y - a.y) - y * (apex.x - a.x);
  return along > 0 && along < length2 && cross * cross < precision2 * length2;
}

// The edge on a segment, among those of the ring of a cavity, that the ring's point lies beyond, or
// nearer to than the root of `precision2`.
template <class Ownership>
std::optional<HalfEdge> hiding_edge(const MeshStore& mesh, const Cavity<Ownership>& cavity,
                                    const Ring& ring, double precision2) {
  for (std::uint32_t i = 0; i < ring.size; ++i) {
    const RingPoint& start = ring.points[i];
    const RingPoint& end = ring.points[i + 1];
    if (end.constrained == 0) continue;
    const double x = end.x - start.x, y = end.y - start.y;
    const double length2 = x * x + y * y;
    const double along = -(start.x * x + start.y * y);
    if (along <= 0 || along >= length2) continue;
    if (end.cross > 0 && end.cross * end.cross >= precision2 * length2) continue;
    for (std::uint32_t k = 0; k < cavity.size(); ++k) {
      const std::uint32_t t = cavity.triangles()[k];
      for (std::uint32_t edge = 0; edge < 3; ++edge)
        if (mesh.triangles[t].vertex[kPrevious[edge]] == end.vertex &&
            mesh.triangles[t].vertex[kNext[edge]] == start.vertex)
          return half_edge(t, edge);
    }
  }
  return std::nullopt;
}

}  // namespace weft
