// SPDX-License-Identifier: Apache-2.0
// The intrinsics of SSE 4.1, for every file of the engine: on x86-64 the compiler's own, on arm64
// SIMDe's of the same names, which give the same bits.
#pragma once

#ifdef __SSE4_1__

#include <smmintrin.h>

#else

#define SIMDE_ENABLE_NATIVE_ALIASES
#include <simde/x86/sse4.1.h>

// SSE's minimum of a and b is b unless a < b, and the maximum b unless a > b, so of two zeros and
// if one is NaN it is the second. SIMDe 0.7.4 has that for floats alone; for doubles it takes
// arm64's own, which are NaN if either is, and know that -0 is less than 0.
#undef _mm_min_pd
#undef _mm_max_pd
#undef _mm_min_sd
#undef _mm_max_sd

inline __m128d _mm_min_pd(__m128d a, __m128d b) {
  return vbslq_f64(vcltq_f64(a, b), a, b);
}
inline __m128d _mm_max_pd(__m128d a, __m128d b) {
  return vbslq_f64(vcgtq_f64(a, b), a, b);
}
inline __m128d _mm_min_sd(__m128d a, __m128d b) {
  return _mm_move_sd(a, _mm_min_pd(a, b));
}
inline __m128d _mm_max_sd(__m128d a, __m128d b) {
  return _mm_move_sd(a, _mm_max_pd(a, b));
}

#endif
