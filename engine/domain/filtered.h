// SPDX-License-Identifier: GPL-3.0-or-later
// The predicates inline: J. R. Shewchuk's first filter ("Adaptive precision floating-point
// arithmetic", 1997), and CGAL's exact ones where it cannot tell.
#pragma once

#include <cmath>

#include "engine/domain/predicates.h"

namespace weft {

// Differences of coordinates that `validate` accepts are 0 or at least 1e-117, so products of two
// do not underflow.
inline constexpr double kOrientationError = 3.3306690738754716e-16;
inline int orientation(Point a, Point b, Point c) {
  const double left = (a.x - c.x) * (b.y - c.y);
  const double right = (a.y - c.y) * (b.x - c.x);
  const double det = left - right;
  const double error = kOrientationError * (std::fabs(left) + std::fabs(right));
  if (det > error) [[likely]]
    return 1;
  if (-det > error) [[likely]]
    return -1;
  return orientation_exact(a, b, c);
}

// 1 where d lies inside the circle through a, b, c, which turn left; -1 outside, 0 on it.
inline int in_circle(Point a, Point b, Point c, Point d) {
  const double adx = a.x - d.x, ady = a.y - d.y;
  const double bdx = b.x - d.x, bdy = b.y - d.y;
  const double cdx = c.x - d.x, cdy = c.y - d.y;
  const double bc = bdx * cdy, cb = cdx * bdy;
  const double ca = cdx * ady, ac = adx * cdy;
  const double ab = adx * bdy, ba = bdx * ady;
  const double a2 = adx * adx + ady * ady;
  const double b2 = bdx * bdx + bdy * bdy;
  const double c2 = cdx * cdx + cdy * cdy;
  const double det = a2 * (bc - cb) + b2 * (ca - ac) + c2 * (ab - ba);
  const double permanent = (std::fabs(bc) + std::fabs(cb)) * a2 +
                           (std::fabs(ca) + std::fabs(ac)) * b2 +
                           (std::fabs(ab) + std::fabs(ba)) * c2;
  // What underflow may cost: a denormal times the square of a difference, at most 1e102.
  const double error = 1.1102230246251577e-15 * permanent + 1e-200;
  if (det > error) return 1;
  if (-det > error) return -1;
  return in_circle_sign_exact(a, b, c, d);
}

}  // namespace weft
