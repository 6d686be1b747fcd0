// SPDX-License-Identifier: Apache-2.0
// Where a bad triangle's Steiner point goes: its circumcentre, or its off-centre where that is
// nearer to the shortest edge (A. Üngör, "Off-centers", 2004). Off-centres cost 5 % at 20 degrees
// and pay from about 32.
#pragma once

#include "engine/geometry.h"
#include "engine/refine/quality_bounds.h"

namespace weft {

inline Point steiner_point(Point a, Point b, Point c, const QualityBounds& quality) {
  const auto distance2 = [](Point p, Point q) {
    return (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y);
  };
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

  const double k = quality.off_centre;
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

}  // namespace weft
