// SPDX-License-Identifier: Apache-2.0
// The predicates inline: a floating-point filter, and the exact predicate (predicates.h) if the
// filter cannot decide. Their signs are those of the exact predicates for coordinates of at most
// 1e50 in magnitude, however small; `validate` ensures that.
//
// Source: the first of the error bounds in J. R. Shewchuk, "Adaptive precision floating-point
// arithmetic and fast robust geometric predicates", 1997: with e = 2^-53, the rounded determinant
// is off by at most (3 + 16 e) e times the sum of its products' magnitudes in `orientation`, by
// (10 + 96 e) e times the permanent in `in_circle`.
//
// Shewchuk assumes that nothing overflows or underflows. The largest term here is below 1e204, so
// nothing overflows. Underflow of differences and sums is harmless: a result below 2^-1022 is
// exact. A product that underflows is off by at most u = 2^-1074 more. In `orientation` two
// products may underflow, so the determinant is off by 2 u more. In `in_circle` u is multiplied by
// the other factor, a sum of squares or of products of differences, of at most 2e101: the three
// terms are off by less than 1e-221 more. The bounds below add more than that, 1e-300 and 1e-200.
// So a domain around 1e-50 wide is triangulated by exact arithmetic alone: much slower, but
// correct.
#pragma once

#include <cmath>

#include "engine/domain/triangulation/predicates.h"

namespace weft {

// How far left - right, rounded, may be from the difference of the two exact products, each of two
// differences of coordinates.
inline double orientation_error(double left, double right) {
  return 3.3306690738754716e-16 * (std::fabs(left) + std::fabs(right)) + 1e-300;
}

// 1 if a, b, c turn left (counter-clockwise), -1 if they turn right, 0 if they are on a
// line.
inline int orientation(Point a, Point b, Point c) {
  const double left = (a.x - c.x) * (b.y - c.y);
  const double right = (a.y - c.y) * (b.x - c.x);
  const double det = left - right;
  const double error = orientation_error(left, right);
  if (det > error) [[likely]]
    return 1;
  if (-det > error) [[likely]]
    return -1;
  return orientation_exact(a, b, c);
}

// 1 if d lies inside the circle through a, b, c; -1 outside, 0 on it. REQUIRES: a, b, c turn
// left.
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
  const double error = 1.1102230246251577e-15 * permanent + 1e-200;
  if (det > error) return 1;
  if (-det > error) return -1;
  return in_circle_sign_exact(a, b, c, d);
}

}  // namespace weft
