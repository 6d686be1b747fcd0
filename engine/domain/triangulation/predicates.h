// SPDX-License-Identifier: Apache-2.0
// Exact geometric predicates on doubles: the sign of a determinant, never its rounded value.
//
// They are CGAL's filtered predicates, compiled once here so that no other file pays for CGAL's
// headers. They are exact for every finite double and thread-safe; most calls end in a static
// filter, about 10 ns. The predicates of filtered.h are faster.
//
//   orientation_exact({0, 0}, {1, 0}, {0, 1})          == 1, a left turn
//   in_circle_exact({0, 0}, {1, 0}, {0, 1}, {1, 1})    == false, on the circle
#pragma once

#include "engine/base/geometry.h"

namespace weft {

// 1 if a, b, c turn left (counter-clockwise), -1 if they turn right, 0 if they are collinear.
int orientation_exact(Point a, Point b, Point c) noexcept;

// Whether p lies strictly inside the circle through a, b, c. REQUIRES: a, b, c turn left.
bool in_circle_exact(Point a, Point b, Point c, Point p) noexcept;

// 1 if p lies inside that circle, -1 outside, 0 on it. REQUIRES: the same.
int in_circle_sign_exact(Point a, Point b, Point c, Point p) noexcept;

}  // namespace weft
