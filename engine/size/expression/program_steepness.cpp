// SPDX-License-Identifier: Apache-2.0
#include "engine/size/expression/program_steepness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

#include "engine/size/expression/interval_arithmetic.h"
#include "engine/size/expression/interval_parts.h"
#include "engine/size/expression/parser.h"
#include "engine/size/expression/threaded_code.h"

namespace weft::expr {

namespace {

constexpr Interval kZero{0, 0, false};

// A value over the box, its derivatives, and a bound on the length of its gradient. The components
// keep x^2 + y^2 tight, the length keeps a distance tight. At a kink, the derivatives of both
// sides.
struct Slope {
  Interval value;
  Interval dx = kZero;
  Interval dy = kZero;
  double length = 0;
};

union Register {
  Register() {}
  Slope slope;
};

double largest(const Interval& a) {
  return std::max(std::fabs(a.lo), std::fabs(a.hi));
}

// Products of finite numbers: 0 times infinity is 0.
double times(double a, double b) {
  return a == 0 || b == 0 ? 0 : a * b;
}

Interval times(const Interval& a, const Interval& b) {
  const std::initializer_list<double> corners{times(a.lo, b.lo), times(a.lo, b.hi),
                                              times(a.hi, b.lo), times(a.hi, b.hi)};
  return {std::min(corners), std::max(corners), false};
}

// An end where infinities cancel is unbounded.
Interval plus(const Interval& a, const Interval& b) {
  const double lo = a.lo + b.lo;
  const double hi = a.hi + b.hi;
  return {std::isnan(lo) ? -kInfinity : lo, std::isnan(hi) ? kInfinity : hi, false};
}

Interval minus(const Interval& a) {
  return {-a.hi, -a.lo, false};
}

Interval either(const Interval& a, const Interval& b) {
  return {std::min(a.lo, b.lo), std::max(a.hi, b.hi), false};
}

Slope steady(const Interval& value) {
  return {value, kZero, kZero, 0};
}

Slope unknown(const Interval& value) {
  return {value, kAnything, kAnything, kInfinity};
}

// f(a): `factor` bounds the derivative of f.
Slope chain(const Interval& value, const Slope& a, const Interval& factor) {
  return {value, times(factor, a.dx), times(factor, a.dy), times(largest(factor), a.length)};
}

// f(a, b): the same for both operands.
Slope chain(const Interval& value, const Slope& a, const Interval& by_a, const Slope& b,
            const Interval& by_b) {
  return {value, plus(times(by_a, a.dx), times(by_b, b.dx)),
          plus(times(by_a, a.dy), times(by_b, b.dy)),
          times(largest(by_a), a.length) + times(largest(by_b), b.length)};
}

// The value is one of the two, and it is not known which.
Slope one_of(const Interval& value, const Slope& a, const Slope& b) {
  return {value, either(a.dx, b.dx), either(a.dy, b.dy), std::max(a.length, b.length)};
}

Slope tightened(Slope slope) {
  const double x = largest(slope.dx);
  const double y = largest(slope.dy);
  const double length = std::sqrt(x * x + y * y);
  if (length < slope.length) slope.length = length;
  if (std::isnan(slope.length)) slope.length = kInfinity;
  for (Interval* const d : {&slope.dx, &slope.dy})
    *d = {std::max(d->lo, -slope.length), std::min(d->hi, slope.length), false};
  return slope;
}

Slope unary(Op op, int exponent, const Slope& a) {
  const Interval& v = a.value;
  const Interval value = unary_bounds(op, exponent, v);
  if (v.lo > v.hi) return unknown(value);  // defined nowhere
  switch (op) {
    case Op::kCopy:
      return {value, a.dx, a.dy, a.length};
    case Op::kNegate:
      return {value, minus(a.dx), minus(a.dy), a.length};
    case Op::kAbs:
      if (v.lo >= 0) return {value, a.dx, a.dy, a.length};
      if (v.hi <= 0) return {value, minus(a.dx), minus(a.dy), a.length};
      return {value, either(a.dx, minus(a.dx)), either(a.dy, minus(a.dy)), a.length};
    case Op::kSqrt:
      if (!(v.hi > 0)) return unknown(value);
      return chain(value, a, {0.5 / value.hi, v.lo > 0 ? 0.5 / value.lo : kInfinity, false});
    case Op::kExp:
      return chain(value, a, value);
    case Op::kLog:
      if (!(v.hi > 0)) return unknown(value);
      return chain(value, a, {1 / v.hi, v.lo > 0 ? 1 / v.lo : kInfinity, false});
    case Op::kSin:
      return chain(value, a, unary_bounds(Op::kCos, 0, v));
    case Op::kCos:
      return chain(value, a, minus(unary_bounds(Op::kSin, 0, v)));
    case Op::kTan:
      if (has_infinity(value)) return unknown(value);  // a pole
      return chain(value, a, plus({1, 1, false}, unary_bounds(Op::kPowN, 2, value)));
    case Op::kPowN: {
      const auto n = static_cast<double>(exponent);
      const Interval power = exponent == 2 ? v : unary_bounds(Op::kPowN, exponent - 1, v);
      return chain(value, a, times({n, n, false}, power));
    }
    case Op::kNot:
    case Op::kDefined:
      return steady(value);
    default:  // kFloor, kCeil, kToNumber: steps
      return value.lo == value.hi ? steady(value) : unknown(value);
  }
}

// If (a, b) changes, hypot changes by at most the length of that change. That is bounded by the
// largest singular value of the matrix of derivatives, which the sums of its rows and columns
// bound.
Slope hypot_slope(const Interval& value, const Slope& a, const Slope& b) {
  const double ax = largest(a.dx);
  const double ay = largest(a.dy);
  const double bx = largest(b.dx);
  const double by = largest(b.dy);
  const double rows = std::max(ax + ay, bx + by);
  const double columns = std::max(ax + bx, ay + by);
  const double length = std::min(std::sqrt(rows) * std::sqrt(columns),
                                 std::sqrt(a.length * a.length + b.length * b.length));
  const auto share = [&](const Interval& part) {
    constexpr Interval kShare{-1, 1, false};
    if (!(value.lo > 0)) return kShare;
    const Interval quotient = binary_bounds(Op::kDivide, part, value);
    return Interval{std::max(quotient.lo, -1.0), std::min(quotient.hi, 1.0), false};
  };
  Slope slope = chain(value, a, share(a.value), b, share(b.value));
  slope.length = std::min(slope.length, length);
  return slope;
}

Slope atan2_slope(const Interval& value, const Slope& y, const Slope& x) {
  if (!(y.value.lo > 0 || y.value.hi < 0 || x.value.lo > 0)) return unknown(value);
  const Interval squares = binary_bounds(Op::kAdd, unary_bounds(Op::kPowN, 2, y.value),
                                         unary_bounds(Op::kPowN, 2, x.value));
  if (!(squares.lo > 0)) return unknown(value);
  return chain(value, y, binary_bounds(Op::kDivide, x.value, squares), x,
               minus(binary_bounds(Op::kDivide, y.value, squares)));
}

Slope pow_slope(const Interval& value, const Slope& base, const Slope& exponent) {
  const Interval& a = base.value;
  const Interval& b = exponent.value;
  if (either_nan(a, b)) return unknown(value);
  if (b.lo == b.hi) {
    const Interval power = binary_bounds(Op::kPow, a, {b.lo - 1, b.lo - 1, false});
    if (power.may_be_nan) return unknown(value);
    return chain(value, base, times(b, power));
  }
  if (!(a.lo > 0)) return unknown(value);
  const Interval by_base = times(b, binary_bounds(Op::kDivide, value, a));
  return chain(value, base, by_base, exponent, times(value, unary_bounds(Op::kLog, 0, a)));
}

Slope binary(Op op, const Slope& a, const Slope& b) {
  constexpr Interval kOne{1, 1, false};
  constexpr Interval kMinusOne{-1, -1, false};
  const Interval value = binary_bounds(op, a.value, b.value);
  if (is_truth(op)) return steady(value);
  if (op == Op::kCoalesce) {
    if (!a.value.may_be_nan) return a;
    return a.value.lo > a.value.hi ? b : unknown(value);
  }
  if (a.value.lo > a.value.hi || b.value.lo > b.value.hi) return unknown(value);
  switch (op) {
    case Op::kAdd:
      return chain(value, a, kOne, b, kOne);
    case Op::kSubtract:
      return chain(value, a, kOne, b, kMinusOne);
    case Op::kMultiply:
      return chain(value, a, b.value, b, a.value);
    case Op::kDivide:
      if (has_zero(b.value)) return unknown(value);
      return chain(value, a, binary_bounds(Op::kDivide, kOne, b.value), b,
                   minus(binary_bounds(Op::kDivide, value, b.value)));
    case Op::kMin:
    case Op::kMax: {
      const bool least = op == Op::kMin;
      const bool always_a = least ? a.value.hi <= b.value.lo : a.value.lo >= b.value.hi;
      const bool always_b = least ? b.value.hi <= a.value.lo : b.value.lo >= a.value.hi;
      Slope slope = always_a ? a : always_b ? b : one_of(value, a, b);
      slope.value = value;
      return slope;
    }
    case Op::kPow:
      return pow_slope(value, a, b);
    case Op::kAtan2:
      return atan2_slope(value, a, b);
    default:  // kHypot
      return hypot_slope(value, a, b);
  }
}

Slope select(const Slope& condition, const Slope& a, const Slope& b) {
  if (condition.value.lo == 1) return a;
  if (condition.value.hi == 0) return b;
  const Interval value = select_bounds(condition.value, a.value, b.value);
  return value.lo == value.hi ? steady(value) : unknown(value);
}

}  // namespace

double steepness(const Program& program, const Box& box,
                 std::span<const Field* const> fields) noexcept {
  std::array<Register, kMaxRegisters> registers;
  constexpr Interval kOne{1, 1, false};
  registers[kInputX].slope = {coordinate_bounds(box.min_x, box.max_x), kOne, kZero, 1};
  registers[kInputY].slope = {coordinate_bounds(box.min_y, box.max_y), kZero, kOne, 1};
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const double length = fields[i]->steepness(box);
    const Interval component{-length, length, false};
    registers[kFirstFieldInput + i].slope = {fields[i]->bounds(box), component, component, length};
  }
  Slope accumulator;
  const auto read = [&](const Operand& operand) -> Slope {
    switch (operand.from) {
      case Operand::From::kAccumulator:
        return accumulator;
      case Operand::From::kRegister:
        return registers[operand.reg].slope;
      default:
        return steady(constant_bounds(operand.value));
    }
  };
  for (const Instruction& instruction : program) {
    const Operand* const operands = instruction.operands.data();
    switch (arity(instruction.op)) {
      case 1:
        accumulator = unary(instruction.op, instruction.exponent, read(operands[0]));
        break;
      case 2:
        accumulator = binary(instruction.op, read(operands[0]), read(operands[1]));
        break;
      default:
        accumulator = select(read(operands[0]), read(operands[1]), read(operands[2]));
    }
    accumulator = tightened(accumulator);
    if (instruction.store) registers[*instruction.store].slope = accumulator;
  }
  return accumulator.length;
}

}  // namespace weft::expr
