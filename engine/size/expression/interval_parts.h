// SPDX-License-Identifier: Apache-2.0
// What the interval counterparts of arithmetic and of the transcendental functions share.
#pragma once

#include <cmath>
#include <initializer_list>
#include <limits>

#include "engine/size/expression/operation.h"
#include "engine/size/interval.h"

namespace weft::expr {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kLargest = std::numeric_limits<double>::max();
inline constexpr Interval kAnything{-kInfinity, kInfinity, true};

// The lesser and the greater, with -0 < +0. REQUIRES: no NaN.
inline double lesser(double a, double b) {
  return a < b || (a == b && std::signbit(a)) ? a : b;
}
inline double greater(double a, double b) {
  return a > b || (a == b && !std::signbit(a)) ? a : b;
}

inline bool has_zero(const Interval& a) {
  return a.lo <= 0 && a.hi >= 0;
}
inline bool has_infinity(const Interval& a) {
  return std::isinf(a.lo) || std::isinf(a.hi);
}
inline bool either_nan(const Interval& a, const Interval& b) {
  return a.may_be_nan || b.may_be_nan;
}

// The least interval that contains all corners; the widest one if a corner is NaN.
inline Interval hull(std::initializer_list<double> corners, bool may_be_nan) {
  Interval result{kInfinity, -kInfinity, may_be_nan};
  for (double corner : corners) {
    if (std::isnan(corner)) return kAnything;
    result.lo = lesser(result.lo, corner);
    result.hi = greater(result.hi, corner);
  }
  return result;
}

// A function's absolute values, as an interval.
inline Interval magnitude(const Interval& a) {
  if (!std::signbit(a.lo)) return a;
  if (std::signbit(a.hi)) return {-a.hi, -a.lo, a.may_be_nan};
  return {0.0, greater(-a.lo, a.hi), a.may_be_nan};
}

// SLEEF's counterparts; see interval_functions.cpp.
Interval function_bounds(Op op, const Interval& a);
Interval function_bounds(Op op, const Interval& a, const Interval& b);

}  // namespace weft::expr
