// SPDX-License-Identifier: Apache-2.0
// Defines what each operation computes, on two lanes at once. The batch evaluator, constant folding
// and the end points of intervals share this definition.
//
// Every function here gives a lane the same bits whatever the other lane holds, and on every
// x86-64-v2 and arm64 machine. Arithmetic is IEEE. The transcendental functions are SLEEF's `cinz`
// ones (deterministic across widths, no fused multiply-add) in their sse4 or advsimdnofma form,
// named in full because the names without the suffix choose an implementation by processor. If
// SLEEF has two accuracies, the faster one is used, because a size needs no last digit. For 8
// lanes, in ns:
//
//            sin   cos   tan   log   hypot  atan2   exp   pow
//   3.5 ulp   25    28    36    30      14     57     -     -
//   1.0 ulp   59    68    92    67     101    139    29   222
//
// N. Shibata and F. Petrogalli, "SLEEF: A Portable Vectorized Library of C Standard Mathematical
// Functions", IEEE TPDS 31(6), 2020.
#pragma once

#include <sleef.h>

#include <cassert>

#include "engine/base/simd.h"
#include "engine/size/expression/operation.h"

#ifdef __SSE4_1__
#define WEFT_SLEEF(function) Sleef_cinz_##function##sse4
#else
#define WEFT_SLEEF(function) Sleef_cinz_##function##advsimdnofma
#endif

namespace weft::expr {

using Lanes = __m128d;

struct Copy {
  static Lanes of(Lanes a) { return a; }
};
struct Negate {
  static Lanes of(Lanes a) { return _mm_xor_pd(a, _mm_set1_pd(-0.0)); }
};
struct Abs {
  static Lanes of(Lanes a) { return _mm_andnot_pd(_mm_set1_pd(-0.0), a); }
};
struct Sqrt {
  static Lanes of(Lanes a) { return _mm_sqrt_pd(a); }
};
struct Floor {
  static Lanes of(Lanes a) { return _mm_floor_pd(a); }
};
struct Ceil {
  static Lanes of(Lanes a) { return _mm_ceil_pd(a); }
};
struct Exp {
  static Lanes of(Lanes a) { return WEFT_SLEEF(expd2_u10)(a); }
};
struct Log {
  static Lanes of(Lanes a) { return WEFT_SLEEF(logd2_u35)(a); }
};
struct Sin {
  static Lanes of(Lanes a) { return WEFT_SLEEF(sind2_u35)(a); }
};
struct Cos {
  static Lanes of(Lanes a) { return WEFT_SLEEF(cosd2_u35)(a); }
};
struct Tan {
  static Lanes of(Lanes a) { return WEFT_SLEEF(tand2_u35)(a); }
};

// x^n by squaring, from the exponent's highest bit down: x^5 is (x^2)^2 * x.
template <int N>
struct PowN {
  static Lanes of(Lanes a) {
    if constexpr (N == 1) {
      return a;
    } else {
      const Lanes half = PowN<N / 2>::of(a);
      const Lanes square = _mm_mul_pd(half, half);
      return N % 2 == 0 ? square : _mm_mul_pd(square, a);
    }
  }
};

struct ToNumber {
  static Lanes of(Lanes mask) { return _mm_and_pd(mask, _mm_set1_pd(1.0)); }
};
struct Not {
  static Lanes of(Lanes mask) { return _mm_xor_pd(mask, _mm_castsi128_pd(_mm_set1_epi64x(-1))); }
};

struct Defined {
  static Lanes of(Lanes a) { return _mm_cmpord_pd(a, a); }
};

struct Add {
  static Lanes of(Lanes a, Lanes b) { return _mm_add_pd(a, b); }
};
struct Subtract {
  static Lanes of(Lanes a, Lanes b) { return _mm_sub_pd(a, b); }
};
struct Multiply {
  static Lanes of(Lanes a, Lanes b) { return _mm_mul_pd(a, b); }
};
struct Divide {
  static Lanes of(Lanes a, Lanes b) { return _mm_div_pd(a, b); }
};
// NaN if either is NaN (minpd alone would lose the first), so that an undefined size is detected.
// Of two zeros, the second.
struct Min {
  static Lanes of(Lanes a, Lanes b) { return _mm_or_pd(_mm_min_pd(a, b), _mm_cmpunord_pd(a, a)); }
};
struct Max {
  static Lanes of(Lanes a, Lanes b) { return _mm_or_pd(_mm_max_pd(a, b), _mm_cmpunord_pd(a, a)); }
};
struct Pow {
  static Lanes of(Lanes a, Lanes b) { return WEFT_SLEEF(powd2_u10)(a, b); }
};
struct Atan2 {
  static Lanes of(Lanes a, Lanes b) { return WEFT_SLEEF(atan2d2_u35)(a, b); }
};
struct Hypot {
  static Lanes of(Lanes a, Lanes b) { return WEFT_SLEEF(hypotd2_u35)(a, b); }
};

struct Coalesce {
  static Lanes of(Lanes a, Lanes b) {
    const Lanes defined = Defined::of(a);
    return _mm_or_pd(_mm_and_pd(defined, a), _mm_andnot_pd(defined, b));
  }
};

// With NaN only NotEqual holds.
struct Less {
  static Lanes of(Lanes a, Lanes b) { return _mm_cmplt_pd(a, b); }
};
struct LessEqual {
  static Lanes of(Lanes a, Lanes b) { return _mm_cmple_pd(a, b); }
};
struct Equal {
  static Lanes of(Lanes a, Lanes b) { return _mm_cmpeq_pd(a, b); }
};
struct NotEqual {
  static Lanes of(Lanes a, Lanes b) { return _mm_cmpneq_pd(a, b); }
};
struct And {
  static Lanes of(Lanes a, Lanes b) { return _mm_and_pd(a, b); }
};
struct Or {
  static Lanes of(Lanes a, Lanes b) { return _mm_or_pd(a, b); }
};

// Selects bits without arithmetic, so the side that is not taken has no effect, even if it is NaN.
struct Select {
  static Lanes of(Lanes mask, Lanes a, Lanes b) {
    return _mm_or_pd(_mm_and_pd(mask, a), _mm_andnot_pd(mask, b));
  }
};

template <int N = 2, class Visitor>
auto visit_power(int exponent, Visitor&& visit) {
  if constexpr (N < kMaxPowN) {
    if (exponent != N) return visit_power<N + 1>(exponent, visit);
  }
  assert(exponent == N);
  return visit(PowN<N>{});
}

// Calls visit(Operation{}) for the operation of one operand that `op` names.
template <class Visitor>
auto visit_unary(Op op, int exponent, Visitor&& visit) {
  switch (op) {
    case Op::kNegate:
      return visit(Negate{});
    case Op::kAbs:
      return visit(Abs{});
    case Op::kSqrt:
      return visit(Sqrt{});
    case Op::kFloor:
      return visit(Floor{});
    case Op::kCeil:
      return visit(Ceil{});
    case Op::kExp:
      return visit(Exp{});
    case Op::kLog:
      return visit(Log{});
    case Op::kSin:
      return visit(Sin{});
    case Op::kCos:
      return visit(Cos{});
    case Op::kTan:
      return visit(Tan{});
    case Op::kPowN:
      return visit_power(exponent, visit);
    case Op::kToNumber:
      return visit(ToNumber{});
    case Op::kNot:
      return visit(Not{});
    case Op::kDefined:
      return visit(Defined{});
    default:
      assert(op == Op::kCopy);
      return visit(Copy{});
  }
}

// The same for two operands.
template <class Visitor>
auto visit_binary(Op op, Visitor&& visit) {
  switch (op) {
    case Op::kAdd:
      return visit(Add{});
    case Op::kSubtract:
      return visit(Subtract{});
    case Op::kMultiply:
      return visit(Multiply{});
    case Op::kDivide:
      return visit(Divide{});
    case Op::kMin:
      return visit(Min{});
    case Op::kMax:
      return visit(Max{});
    case Op::kPow:
      return visit(Pow{});
    case Op::kAtan2:
      return visit(Atan2{});
    case Op::kHypot:
      return visit(Hypot{});
    case Op::kCoalesce:
      return visit(Coalesce{});
    case Op::kLess:
      return visit(Less{});
    case Op::kLessEqual:
      return visit(LessEqual{});
    case Op::kEqual:
      return visit(Equal{});
    case Op::kNotEqual:
      return visit(NotEqual{});
    case Op::kAnd:
      return visit(And{});
    default:
      assert(op == Op::kOr);
      return visit(Or{});
  }
}

// One value at a time, for folding and for the end points of intervals. A truth value is 1 or 0.
inline double apply(Op op, int exponent, double a) {
  return visit_unary(op, exponent, [&](auto f) {
    const Lanes value = f.of(_mm_set1_pd(a));
    return _mm_cvtsd_f64(is_truth(op) ? ToNumber::of(value) : value);
  });
}
inline double apply(Op op, double a, double b) {
  return visit_binary(op, [&](auto f) {
    const Lanes value = f.of(_mm_set1_pd(a), _mm_set1_pd(b));
    return _mm_cvtsd_f64(is_truth(op) ? ToNumber::of(value) : value);
  });
}

}  // namespace weft::expr
