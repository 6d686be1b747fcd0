// SPDX-License-Identifier: Apache-2.0
#include "engine/size/expression/interval_arithmetic.h"

#include "engine/size/expression/interval_parts.h"
#include "engine/size/expression/lanes.h"

namespace weft::expr {

namespace {

constexpr Interval kFalse{0, 0, false};
constexpr Interval kTrue{1, 1, false};
constexpr Interval kEitherTruth{0, 1, false};

Interval truth(bool always, bool never) {
  return always ? kTrue : never ? kFalse : kEitherTruth;
}

// NaN in all of the box, which the bounds of a field may say.
bool never_defined(const Interval& a) {
  return a.lo > a.hi;
}

// The value if an operand is NaN.
Interval of_undefined(Op op) {
  switch (op) {
    case Op::kLess:
    case Op::kLessEqual:
    case Op::kEqual:
      return kFalse;
    case Op::kNotEqual:
      return kTrue;
    case Op::kPow:    // pow(NaN, 0) is 1
    case Op::kHypot:  // hypot(NaN, inf) is inf
      return kAnything;
    default:
      return kUndefined;
  }
}

// For operations whose computed value never decreases, and that never make a NaN.
Interval increasing(Op op, const Interval& a) {
  return {apply(op, 0, a.lo), apply(op, 0, a.hi), a.may_be_nan};
}

Interval sqrt_bounds(const Interval& a) {
  if (a.hi < 0) return kUndefined;
  const double lo = a.lo < 0 ? -0.0 : apply(Op::kSqrt, 0, a.lo);
  return {lo, apply(Op::kSqrt, 0, a.hi), a.may_be_nan || a.lo < 0};
}

Interval power_bounds(int exponent, const Interval& a) {
  const Interval base = exponent % 2 == 0 ? magnitude(a) : a;
  return {apply(Op::kPowN, exponent, base.lo), apply(Op::kPowN, exponent, base.hi), a.may_be_nan};
}

// inf - inf is the only NaN; where an end point meets it, that side is unbounded.
Interval sum_bounds(const Interval& a, const Interval& b) {
  const double lo = a.lo + b.lo;
  const double hi = a.hi + b.hi;
  const bool cancels =
      (a.lo == -kInfinity && b.hi == kInfinity) || (a.hi == kInfinity && b.lo == -kInfinity);
  return {std::isnan(lo) ? -kInfinity : lo, std::isnan(hi) ? kInfinity : hi,
          either_nan(a, b) || cancels};
}

// A product is monotone in each factor, in a direction that only the other's sign decides.
Interval product_bounds(const Interval& a, const Interval& b) {
  if ((has_zero(a) && has_infinity(b)) || (has_infinity(a) && has_zero(b))) return kAnything;
  return hull({a.lo * b.lo, a.lo * b.hi, a.hi * b.lo, a.hi * b.hi}, either_nan(a, b));
}

Interval quotient_bounds(const Interval& a, const Interval& b) {
  const bool undefined = (has_zero(a) && has_zero(b)) || (has_infinity(a) && has_infinity(b));
  if (undefined) return kAnything;
  // Between -0 and +0 the quotient jumps from one infinity to the other.
  if (std::signbit(b.lo) != std::signbit(b.hi)) {
    return {-kInfinity, kInfinity, either_nan(a, b)};
  }
  return hull({a.lo / b.lo, a.lo / b.hi, a.hi / b.lo, a.hi / b.hi}, either_nan(a, b));
}

// Min and Max give the second of two zeros, whatever its sign.
double with_open_sign(double end, double zero, bool may_be) {
  return end == 0 ? (may_be ? zero : -zero) : end;
}

Interval extremum_bounds(Op op, const Interval& a, const Interval& b) {
  return {with_open_sign(apply(op, a.lo, b.lo), -0.0, std::signbit(a.lo) || std::signbit(b.lo)),
          with_open_sign(apply(op, a.hi, b.hi), 0.0, !std::signbit(a.hi) || !std::signbit(b.hi)),
          either_nan(a, b)};
}

Interval coalesce_bounds(const Interval& a, const Interval& b) {
  if (!a.may_be_nan) return a;
  if (never_defined(a) || never_defined(b)) {
    Interval defined = never_defined(a) ? b : a;
    defined.may_be_nan = b.may_be_nan;
    return defined;
  }
  return hull({a.lo, a.hi, b.lo, b.hi}, b.may_be_nan);
}

}  // namespace

Interval coordinate_bounds(double lo, double hi) {
  if (!(lo <= hi)) return kAnything;
  return {lo == 0 ? -0.0 : lo, hi == 0 ? 0.0 : hi, false};
}

Interval constant_bounds(double value) {
  return std::isnan(value) ? kAnything : Interval{value, value, false};
}

Interval unary_bounds(Op op, int exponent, const Interval& a) {
  if (op == Op::kDefined) return truth(!a.may_be_nan, never_defined(a));
  if (never_defined(a)) return of_undefined(op);
  switch (op) {
    case Op::kCopy:
    case Op::kToNumber:
      return a;
    case Op::kNegate:
      return {-a.hi, -a.lo, a.may_be_nan};
    case Op::kAbs:
      return magnitude(a);
    case Op::kSqrt:
      return sqrt_bounds(a);
    case Op::kFloor:
    case Op::kCeil:
      return increasing(op, a);
    case Op::kPowN:
      return power_bounds(exponent, a);
    case Op::kNot:
      return {1 - a.hi, 1 - a.lo, false};
    default:
      return function_bounds(op, a);
  }
}

Interval binary_bounds(Op op, const Interval& a, const Interval& b) {
  if (op == Op::kCoalesce) return coalesce_bounds(a, b);
  if (never_defined(a) || never_defined(b)) return of_undefined(op);
  const bool nan = either_nan(a, b);
  switch (op) {
    case Op::kAdd:
      return sum_bounds(a, b);
    case Op::kSubtract:
      return sum_bounds(a, {-b.hi, -b.lo, b.may_be_nan});
    case Op::kMultiply:
      return product_bounds(a, b);
    case Op::kDivide:
      return quotient_bounds(a, b);
    case Op::kMin:
    case Op::kMax:
      return extremum_bounds(op, a, b);
    case Op::kLess:
      return truth(a.hi < b.lo && !nan, a.lo >= b.hi);
    case Op::kLessEqual:
      return truth(a.hi <= b.lo && !nan, a.lo > b.hi);
    case Op::kEqual:
      return truth(a.lo == b.hi && a.hi == b.lo && !nan, a.lo > b.hi || a.hi < b.lo);
    case Op::kNotEqual:
      return truth(a.lo > b.hi || a.hi < b.lo, a.lo == b.hi && a.hi == b.lo && !nan);
    case Op::kAnd:
      return {std::fmin(a.lo, b.lo), std::fmin(a.hi, b.hi), false};
    case Op::kOr:
      return {std::fmax(a.lo, b.lo), std::fmax(a.hi, b.hi), false};
    default:
      return function_bounds(op, a, b);
  }
}

Interval select_bounds(const Interval& condition, const Interval& a, const Interval& b) {
  if (condition.lo == 1) return a;
  if (condition.hi == 0) return b;
  if (never_defined(a) || never_defined(b)) {
    Interval defined = never_defined(a) ? b : a;
    defined.may_be_nan = true;
    return defined;
  }
  return hull({a.lo, a.hi, b.lo, b.hi}, either_nan(a, b));
}

}  // namespace weft::expr
