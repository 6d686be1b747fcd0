// SPDX-License-Identifier: Apache-2.0
// Exact signs of geometric determinants. Each is first computed in double with a bound on its
// rounding error (J. R. Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust
// Geometric Predicates", 1997, bounds A); if the bound does not decide, in integers.
// REQUIRES: finite coordinates, of any magnitude. Thread-safe.
#pragma once

#include <cstdint>

#include "checker/domain.h"

namespace weft::check {

// Sign of (b - a) x (d - c): > 0 if c->d points to the left of a->b.
int cross_sign(Vec2 a, Vec2 b, Vec2 c, Vec2 d);

// > 0 if a, b, c turn counter-clockwise, < 0 if clockwise, 0 if they are collinear.
inline int orientation(Vec2 a, Vec2 b, Vec2 c) {
  return cross_sign(a, b, a, c);
}

// > 0 if d lies strictly inside the circle through a, b, c, which must be counter-clockwise; 0 if
// on it, < 0 outside.
int in_circle(Vec2 a, Vec2 b, Vec2 c, Vec2 d);

// mantissa * 2^exponent, exactly.
struct Dyadic {
  std::int64_t mantissa = 0;
  int exponent = 0;
};

Dyadic decompose(double value);

}  // namespace weft::check
