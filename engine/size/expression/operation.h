// SPDX-License-Identifier: Apache-2.0
// The operations that a size expression is made of, after parsing.
//
// A value is a number or a truth value. Inside a program a truth value is a mask: all bits set or
// none.
#pragma once

#include <cstdint>

namespace weft::expr {

enum class Op : std::uint8_t {
  // Leaves.
  kConstant,
  kInput,  // a number that each point brings: its x, its y, or the value of a field there
  kFalse,  // kFalse and kTrue are folded away: no program contains them
  kTrue,
  // number -> number
  kCopy,  // only to copy a bare input or constant into the result
  kNegate,
  kAbs,
  kSqrt,
  kFloor,
  kCeil,
  kExp,
  kLog,
  kSin,
  kCos,
  kTan,
  kPowN,  // to a fixed integer exponent, 2 to kMaxPowN
  // truth -> number, truth -> truth
  kToNumber,
  kNot,
  // number -> truth
  kDefined,  // whether it is not NaN
  // number, number -> number
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kMin,
  kMax,
  kPow,
  kAtan2,
  kHypot,
  kCoalesce,  // the first, or the second where the first is NaN
  // number, number -> truth
  kLess,
  kLessEqual,
  kEqual,
  kNotEqual,
  // truth, truth -> truth
  kAnd,
  kOr,
  // truth, number, number -> number
  kSelect,
};

// Powers up to this exponent are products.
inline constexpr int kMaxPowN = 16;

constexpr int arity(Op op) {
  if (op <= Op::kTrue) return 0;
  if (op <= Op::kDefined) return 1;
  if (op <= Op::kOr) return 2;
  return 3;
}

constexpr bool is_truth(Op op) {
  return op == Op::kFalse || op == Op::kTrue || op == Op::kNot || op == Op::kDefined ||
         (op >= Op::kLess && op <= Op::kOr);
}

}  // namespace weft::expr
