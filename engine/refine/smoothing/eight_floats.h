// SPDX-License-Identifier: Apache-2.0
// Eight floats in two registers of SSE, or eight masks of all bits or none.
#pragma once

#include "engine/base/simd.h"

namespace weft {

struct EightFloats {
  __m128 low;
  __m128 high;

  static EightFloats all(float value) { return {_mm_set1_ps(value), _mm_set1_ps(value)}; }
  static EightFloats of(const float (&values)[8]) {
    return {_mm_loadu_ps(values), _mm_loadu_ps(values + 4)};
  }

  float lane(int k) const {
    alignas(16) float lanes[8];
    _mm_store_ps(lanes, low);
    _mm_store_ps(lanes + 4, high);
    return lanes[k];
  }
  // Returns the largest, and sets `lane` to the first lane that holds it; to any lane if it is NaN.
  float largest(int& lane) const {
    __m128 most = _mm_max_ps(low, high);
    most = _mm_max_ps(most, _mm_shuffle_ps(most, most, _MM_SHUFFLE(1, 0, 3, 2)));
    most = _mm_max_ps(most, _mm_shuffle_ps(most, most, _MM_SHUFFLE(2, 3, 0, 1)));
    const int equal =
        _mm_movemask_ps(_mm_cmpeq_ps(low, most)) | _mm_movemask_ps(_mm_cmpeq_ps(high, most)) << 4;
    lane = __builtin_ctz(static_cast<unsigned>(equal) | 0x80);
    return _mm_cvtss_f32(most);
  }
};

inline EightFloats operator+(EightFloats a, EightFloats b) {
  return {_mm_add_ps(a.low, b.low), _mm_add_ps(a.high, b.high)};
}
inline EightFloats operator-(EightFloats a, EightFloats b) {
  return {_mm_sub_ps(a.low, b.low), _mm_sub_ps(a.high, b.high)};
}
inline EightFloats operator*(EightFloats a, EightFloats b) {
  return {_mm_mul_ps(a.low, b.low), _mm_mul_ps(a.high, b.high)};
}
inline EightFloats operator/(EightFloats a, EightFloats b) {
  return {_mm_div_ps(a.low, b.low), _mm_div_ps(a.high, b.high)};
}
inline EightFloats operator&(EightFloats a, EightFloats b) {
  return {_mm_and_ps(a.low, b.low), _mm_and_ps(a.high, b.high)};
}
inline EightFloats operator>(EightFloats a, EightFloats b) {
  return {_mm_cmpgt_ps(a.low, b.low), _mm_cmpgt_ps(a.high, b.high)};
}
inline EightFloats min(EightFloats a, EightFloats b) {
  return {_mm_min_ps(a.low, b.low), _mm_min_ps(a.high, b.high)};
}
inline EightFloats max(EightFloats a, EightFloats b) {
  return {_mm_max_ps(a.low, b.low), _mm_max_ps(a.high, b.high)};
}
// `a` if the mask is set, otherwise `b`.
inline EightFloats select(EightFloats mask, EightFloats a, EightFloats b) {
  return {_mm_blendv_ps(b.low, a.low, mask.low), _mm_blendv_ps(b.high, a.high, mask.high)};
}

}  // namespace weft
