// SPDX-License-Identifier: Apache-2.0
// Where a bad triangle's Steiner point goes.
//
// If it is skinny, or there is no lattice: to its circumcentre, or to its off-centre if that is
// nearer to the shortest edge (A. Üngör, "Off-centers", 2004). For a skinny triangle this is only
// the first of the places that are tried (petal.h), the nearest to the edge's bisector.
//
// If it is too large: to the point of the lattice (lattice.h) nearest to its circumcentre,
// provided that this point
//   - lies in the circumdisk, at most sqrt(kInside) of the radius from the centre, so that the
//     insertion removes the triangle;
//   - keeps kClearance spacings from the triangle's corners, and later from all vertices that it
//     would be joined to.
// In a lattice that lacks only some points these always hold. Where two lattices, or a
// lattice and a segment, meet, points too close to others are left out, and circumcentres close the
// gap. Refinement ends as before: a point keeps kClearance spacings from the vertices that it sees,
// or the circumradius of a triangle that is too large.
//
// bench/README.md says what kClearance decides. Thread-safety: pure functions.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "engine/base/geometry.h"
#include "engine/base/vector.h"
#include "engine/refine/quality_bounds.h"
#include "engine/refine/storage/mesh_store.h"
#include "engine/size/lattice/lattice.h"

namespace weft {

// The square of kClearance, in squared spacings.
inline constexpr double kLatticeClearance2 = 0.55 * 0.55;

// The circumcentre if `off_centre` is 0, otherwise the off-centre of QualityBounds.
inline Point steiner_point(Point a, Point b, Point c, double off_centre) {
  const double opposite_a = distance2(b, c);
  const double opposite_b = distance2(c, a);
  const double opposite_c = distance2(a, b);
  // Turn the triangle so that a-b is its shortest edge: it is best conditioned there.
  if (opposite_a <= opposite_b && opposite_a <= opposite_c) {
    const Point first = a;
    a = b;
    b = c;
    c = first;
  } else if (opposite_b <= opposite_c && opposite_b <= opposite_a) {
    const Point second = b;
    b = a;
    a = c;
    c = second;
  }
  const double bx = b.x - a.x;
  const double by = b.y - a.y;
  const double cx = c.x - a.x;
  const double cy = c.y - a.y;
  const double b2 = bx * bx + by * by;
  const double c2 = cx * cx + cy * cy;
  const double scale = 0.5 / (bx * cy - by * cx);
  double x = (cy * b2 - by * c2) * scale;
  double y = (bx * c2 - cx * b2) * scale;

  const double k = off_centre;
  const double from_middle_x = x - 0.5 * bx;
  const double from_middle_y = y - 0.5 * by;
  const double circumcentre2 = from_middle_x * from_middle_x + from_middle_y * from_middle_y;
  const bool same_side = from_middle_y * bx - from_middle_x * by > 0;
  if (k > 0 && same_side && k * k * b2 < circumcentre2) {
    x = 0.5 * bx - k * by;
    y = 0.5 * by + k * bx;
  }
  return {a.x + x, a.y + y};
}

inline Point steiner_point(Point a, Point b, Point c, const QualityBounds& quality) {
  return steiner_point(a, b, c, quality.off_centre);
}

// Of a triangle that is too large and whose Steiner point would be beyond a segment or at one: a
// point in it, away from its own edges on segments, and the squared distance that the point must
// keep from all vertices that it would be joined to, above a quarter of the bound on areas, so that
// refinement ends by packing.
struct MiddlePoint {
  Point at;
  double clearance2;
};
inline MiddlePoint middle_beside_segments(const MeshStore& mesh, const Triangle& triangle) {
  double x = 0, y = 0, sum = 0;
  std::array<Point, 3> corner;
  for (std::uint32_t k = 0; k < 3; ++k) {
    corner[k] = mesh.vertices[triangle.vertex[k]];
    const double weight = triangle.on_segment(k) ? 2 : 1;  // of the corner opposite
    x += weight * corner[k].x;
    y += weight * corner[k].y;
    sum += weight;
  }
  const double area = 0.5 * cross(corner[1] - corner[0], corner[2] - corner[0]);
  return {{x / sum, y / sum}, 0.25 * area};
}

// Whether a triangle that is too large takes the lattice point `nearest` instead of its
// circumcentre. The other vertices that this would be joined to are not known yet.
inline bool takes_lattice_point(Point a, Point b, Point c, Point circumcentre,
                                const LatticePoint& nearest) {
  constexpr double kInside = 0.96;  // of the squared radius
  const Point p = nearest.at;
  const double clear2 = std::min(std::min(distance2(p, a), distance2(p, b)), distance2(p, c));
  return nearest.spacing2 > 0 && clear2 >= kLatticeClearance2 * nearest.spacing2 &&
         distance2(p, circumcentre) <= kInside * distance2(a, circumcentre);
}

}  // namespace weft
