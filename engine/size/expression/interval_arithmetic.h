// SPDX-License-Identifier: Apache-2.0
// Interval counterparts of the operations in lanes.h: for operands within the given intervals, the
// computed result lies within the returned one, bit for bit.
//
// IEEE addition, subtraction, multiplication, division, square root and products round
// monotonically, so the computed end points ARE the bounds of the computed values: nothing is
// widened, and a constant stays a point. SLEEF's functions are within a few units in the
// last place of functions that are monotone between known points, so their end points are widened
// by a relative 1e-14.
//
// -0 lies below +0 here: an interval from +0 contains no -0. So 1/(x^2+y^2) over a box around the
// origin has a lower bound.
//
// W. Kahan, "How Futile are Mindless Assessments of Roundoff"; IEEE 1788-2015 for the terms.
#pragma once

#include "engine/size/expression/operation.h"
#include "engine/size/interval.h"

namespace weft::expr {

// A truth value is an interval within [0, 1].
Interval unary_bounds(Op op, int exponent, const Interval& a);
Interval binary_bounds(Op op, const Interval& a, const Interval& b);
Interval select_bounds(const Interval& condition, const Interval& a, const Interval& b);

// The interval of a coordinate between lo and hi. If it contains a zero, it contains both.
Interval coordinate_bounds(double lo, double hi);
// The interval of one value; for NaN, the widest one.
Interval constant_bounds(double value);

}  // namespace weft::expr
