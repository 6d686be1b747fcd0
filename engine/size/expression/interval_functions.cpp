// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numbers>

#include "engine/size/expression/interval_parts.h"
#include "engine/size/expression/lanes.h"

namespace weft::expr {

namespace {

// SLEEF errs by at most 3.5 units in the last place: 8e-16. The absolute part is for results near
// the smallest normal number, where SLEEF may lose digits or give 0.
constexpr double kRelative = 1e-14;
constexpr double kAbsolute = 1e-300;

// A result that overflowed at an end point may be finite beside it.
double below(double value) {
  const double finite = std::min(value, kLargest);
  return finite - (std::abs(finite) * kRelative + kAbsolute);
}
double above(double value) {
  const double finite = std::max(value, -kLargest);
  return finite + (std::abs(finite) * kRelative + kAbsolute);
}
Interval widened(const Interval& a) {
  return {below(a.lo), above(a.hi), a.may_be_nan};
}

// Of a function that is never negative, not even -0.
Interval not_negative(const Interval& a) {
  return {greater(a.lo, 0.0), a.hi, a.may_be_nan};
}

Interval exp_bounds(const Interval& a) {
  return not_negative(widened({apply(Op::kExp, 0, a.lo), apply(Op::kExp, 0, a.hi), a.may_be_nan}));
}

Interval log_bounds(const Interval& a) {
  if (a.hi < 0) return kUndefined;
  const double lo = a.lo <= 0 ? -kInfinity : apply(Op::kLog, 0, a.lo);
  return widened({lo, apply(Op::kLog, 0, a.hi), a.may_be_nan || a.lo < 0});
}

// Whether some phase + k * period, k whole, may lie in [lo, hi]. Wrong only towards true: the
// quotients are off by far less than the slack while |a| < kFarOut.
bool may_contain(const Interval& a, double phase, double period) {
  constexpr double kSlack = 1e-9;
  return std::floor((a.hi - phase) / period + kSlack) >=
         std::ceil((a.lo - phase) / period - kSlack);
}

constexpr double kFarOut = 1e5;

bool is_near(const Interval& a) {
  return a.lo > -kFarOut && a.hi < kFarOut;
}

Interval wave_bounds(Op op, const Interval& a, double crest, double trough) {
  constexpr double kPeriod = 2 * std::numbers::pi;
  Interval result{-1, 1, a.may_be_nan || has_infinity(a)};
  if (is_near(a)) {
    const double at_lo = apply(op, 0, a.lo);
    const double at_hi = apply(op, 0, a.hi);
    if (!may_contain(a, trough, kPeriod)) result.lo = lesser(at_lo, at_hi);
    if (!may_contain(a, crest, kPeriod)) result.hi = greater(at_lo, at_hi);
  }
  return widened(result);
}

Interval tan_bounds(const Interval& a) {
  if (!is_near(a) || may_contain(a, std::numbers::pi / 2, std::numbers::pi)) {
    return {-kInfinity, kInfinity, a.may_be_nan || has_infinity(a)};
  }
  return widened({apply(Op::kTan, 0, a.lo), apply(Op::kTan, 0, a.hi), a.may_be_nan});
}

Interval hypot_bounds(const Interval& a, const Interval& b) {
  const Interval u = magnitude(a);
  const Interval v = magnitude(b);
  // hypot(inf, NaN) is inf.
  const double hi = either_nan(a, b) ? kInfinity : apply(Op::kHypot, u.hi, v.hi);
  return not_negative(widened({apply(Op::kHypot, u.lo, v.lo), hi, either_nan(a, b)}));
}

// Monotone in each argument in any box that the cut, the negative x axis, does not touch.
Interval atan2_bounds(const Interval& y, const Interval& x) {
  const bool nan = either_nan(y, x);
  if (!(y.lo > 0 || y.hi < 0 || x.lo > 0)) {
    return widened({-std::numbers::pi, std::numbers::pi, nan});
  }
  return widened(hull({apply(Op::kAtan2, y.lo, x.lo), apply(Op::kAtan2, y.lo, x.hi),
                       apply(Op::kAtan2, y.hi, x.lo), apply(Op::kAtan2, y.hi, x.hi)},
                      nan));
}

// Monotone in each argument for a base that is not negative.
Interval positive_pow_bounds(const Interval& base, const Interval& exponent) {
  return not_negative(
      widened(hull({apply(Op::kPow, base.lo, exponent.lo), apply(Op::kPow, base.lo, exponent.hi),
                    apply(Op::kPow, base.hi, exponent.lo), apply(Op::kPow, base.hi, exponent.hi)},
                   false)));
}

Interval whole_pow_bounds(const Interval& base, const Interval& exponent) {
  const Interval power = positive_pow_bounds(magnitude(base), exponent);
  const bool even = std::floor(exponent.lo / 2) == exponent.lo / 2;
  return even ? power : Interval{-power.hi, power.hi, false};
}

Interval pow_bounds(const Interval& base, const Interval& exponent) {
  // pow(NaN, 0) and pow(1, NaN) are 1.
  if (either_nan(base, exponent)) return kAnything;
  if (!std::signbit(base.lo)) return positive_pow_bounds(base, exponent);
  const bool fixed = exponent.lo == exponent.hi;
  if (fixed && std::floor(exponent.lo) == exponent.lo) return whole_pow_bounds(base, exponent);
  if (base.lo < 0) return kAnything;
  // The base may be -0, which differs from +0 for odd integer exponents alone.
  const Interval power = positive_pow_bounds(magnitude(base), exponent);
  if (fixed) return power;
  return exponent.lo > 0 ? Interval{lesser(power.lo, -0.0), power.hi, false} : kAnything;
}

}  // namespace

Interval function_bounds(Op op, const Interval& a) {
  constexpr double kQuarter = std::numbers::pi / 2;
  switch (op) {
    case Op::kExp:
      return exp_bounds(a);
    case Op::kLog:
      return log_bounds(a);
    case Op::kSin:
      return wave_bounds(op, a, kQuarter, -kQuarter);
    case Op::kCos:
      return wave_bounds(op, a, 0, std::numbers::pi);
    default:
      assert(op == Op::kTan);
      return tan_bounds(a);
  }
}

Interval function_bounds(Op op, const Interval& a, const Interval& b) {
  switch (op) {
    case Op::kPow:
      return pow_bounds(a, b);
    case Op::kAtan2:
      return atan2_bounds(a, b);
    default:
      assert(op == Op::kHypot);
      return hypot_bounds(a, b);
  }
}

}  // namespace weft::expr
