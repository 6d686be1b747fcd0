// SPDX-License-Identifier: Apache-2.0
// The bounds on a triangle's shape, and the test of a whole ring of new triangles at once.
//
// With edges a, b from p, e = b - a, and A2 = a x b twice the area, the smallest angle is opposite
// the shortest edge m, and sin^2 = A2^2 m^2 / (|a|^2 |b|^2 |e|^2). So no root and no division is
// needed, the products are those of the walk (cavity.h), and one loop without branches judges the
// ring, two triangles per step in the lanes of SSE registers.
//
// Units: squared lengths and doubled areas, in units of the domain; angles by their squared sine.
// Thread-safety: values and pure functions.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "engine/base/simd.h"
#include "engine/refine/cavity.h"
#include "engine/refine/lens.h"
#include "engine/refine/storage/mesh_store.h"
#include "engine/size/lattice/lattice.h"

namespace weft {

struct QualityBounds {
  double sin2 = 0;        // of the minimum angle
  double off_centre = 0;  // see steiner_point.h
  double min_edge2 = 0;   // squared floor on the length of new edges that the caller asks for
  double lens = kNoLens;  // the lens for skinny triangles (lens.h)
  // That of points beside segments that are kept: an angle there may be the bound, and no less, nor
  // below 5.7 degrees.
  double kept_lens = kDiametralDisk;
  double precision2 = 0;   // squared length below which double precision ends
  double min_length2 = 0;  // the larger of the two
  LatticeShape lattice{};  // of the points for triangles that are too large

  // Refinement makes no edge below min_edge or `precision`. REQUIRES: 0 <= min_angle_deg <=
  // kMaxMinAngleDeg.
  static QualityBounds from(double min_angle_deg, double min_edge, double precision);

  // Those of the stages before the last (smoothing/stages.h): 20 degrees are enough.
  QualityBounds eased() const {
    constexpr double kSin2 = 0.117;  // just above 20 degrees
    QualityBounds bounds = *this;
    bounds.sin2 = std::min(sin2, kSin2);
    return bounds;
  }
};

// Triangles over the integral of 1 / bound, as they come out; and the area of most over the bound.
inline double triangles_per_bound(const LatticeShape& lattice) {
  return lattice.exists() ? 1.03 / lattice.area_ratio : 1.55;
}
inline double area_over_bound(const QualityBounds& quality) {
  return quality.lattice.exists() ? quality.lattice.area_ratio : 0.64;
}

// Squared circumradius of a counter-clockwise triangle.
inline double circumradius2(Point a, Point b, Point c) {
  const double doubled = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  return distance2(a, b) / doubled * (distance2(b, c) / doubled) * distance2(c, a) / 4;
}

// The result of judging a ring of new triangles. Badness is per triangle, the rest is for the ring.
struct RingVerdict {
  bool flat = false;       // a triangle may not be counter-clockwise: use the exact predicate
  bool too_close = false;  // p is nearer to a point of the ring than the floor
  double farthest2 = 0;    // squared distance from p to the farthest point of the ring
  double nearest2 = 0;     // and to the nearest
};

// An area bound for every triangle of a ring. Two at once: those of triangles i and i + 1.
struct UniformAreaBound {
  double doubled;
  __m128d two_from(std::uint32_t) const { return _mm_set1_pd(doubled); }
};

// One for each triangle from `first` on.
struct DoubledBounds {
  const double* doubled;
  std::uint32_t first = 0;
  __m128d two_from(std::uint32_t i) const { return _mm_loadu_pd(doubled + (i - first)); }
};

// The badness of a triangle that is larger than its bound: four levels per octave of the ratio,
// from the difference of the numbers' bits, which is a logarithm to 9 %. REQUIRES: 0 < bound <
// area.
inline Badness badness_of_size(double area, double bound) {
  const std::uint64_t quarters =
      (std::bit_cast<std::uint64_t>(area) - std::bit_cast<std::uint64_t>(bound)) >> 50;
  return kLarge + std::min(static_cast<std::uint32_t>(quarters), kWorst - kLarge);
}

// Sets badness[i] of the triangles first <= i < last. `doubled_bound` has twice the upper bound on
// the area of each. REQUIRES: at least two triangles.
//
// Judges two triangles per step; if their number is odd, the last step judges one again.
template <class AreaBound>
inline RingVerdict judge_ring(const Ring& ring, std::uint32_t first, std::uint32_t last,
                              const QualityBounds& quality, const AreaBound& doubled_bound,
                              Badness* __restrict badness) {
  constexpr double kOrientationError = 4 * 0x1p-53;
  const RingPoint* const __restrict points = ring.points.data();
  const __m128d sin2 = _mm_set1_pd(quality.sin2);
  __m128d nearest2 = _mm_set1_pd(std::numeric_limits<double>::infinity());
  __m128d farthest2 = _mm_setzero_pd();
  __m128d flat = _mm_setzero_pd();
  for (std::uint32_t step = first; step < last; step += 2) {
    const std::uint32_t i = std::min(step, last - 2);
    const RingPoint& p = points[i];
    const RingPoint& q = points[i + 1];
    const RingPoint& r = points[i + 2];
    const __m128d at_q = _mm_load_pd(&q.x);
    const __m128d first_edge = _mm_sub_pd(at_q, _mm_load_pd(&p.x));
    const __m128d second_edge = _mm_sub_pd(_mm_load_pd(&r.x), at_q);
    const __m128d length_cross_p = _mm_load_pd(&p.length2);
    const __m128d length_cross_q = _mm_load_pd(&q.length2);
    const __m128d length_cross_r = _mm_load_pd(&r.length2);
    const __m128d a2 = _mm_unpacklo_pd(length_cross_p, length_cross_q);
    const __m128d b2 = _mm_unpacklo_pd(length_cross_q, length_cross_r);
    const __m128d area2 = _mm_unpackhi_pd(length_cross_q, length_cross_r);
    const __m128d e2 =
        _mm_hadd_pd(_mm_mul_pd(first_edge, first_edge), _mm_mul_pd(second_edge, second_edge));
    const __m128d nearer2 = _mm_min_pd(a2, b2);
    const __m128d shortest2 = _mm_min_pd(nearer2, e2);
    nearest2 = _mm_min_pd(nearest2, nearer2);
    farthest2 = _mm_max_pd(farthest2, _mm_max_pd(a2, b2));
    flat = _mm_or_pd(
        flat, _mm_cmple_pd(area2, _mm_mul_pd(_mm_set1_pd(kOrientationError), _mm_add_pd(a2, b2))));
    const __m128d skinny = _mm_cmplt_pd(_mm_mul_pd(_mm_mul_pd(area2, area2), shortest2),
                                        _mm_mul_pd(sin2, _mm_mul_pd(_mm_mul_pd(a2, b2), e2)));
    const __m128d bound = doubled_bound.two_from(i);
    const __m128d large = _mm_cmpgt_pd(area2, bound);
    // As badness_of_size.
    const __m128i quarters =
        _mm_srli_epi64(_mm_sub_epi64(_mm_castpd_si128(area2), _mm_castpd_si128(bound)), 50);
    const __m128i by_size = _mm_add_epi32(_mm_min_epu32(quarters, _mm_set1_epi32(kWorst - kLarge)),
                                          _mm_set1_epi32(kLarge));
    const __m128i by_shape = _mm_srli_epi64(_mm_castpd_si128(skinny), 63);
    const __m128i worse = _mm_blendv_epi8(by_shape, by_size, _mm_castpd_si128(large));
    _mm_storel_epi64(reinterpret_cast<__m128i*>(badness + i),
                     _mm_shuffle_epi32(worse, _MM_SHUFFLE(3, 1, 2, 0)));
  }
  const auto any = [](__m128d mask) { return _mm_movemask_pd(mask) != 0; };
  const double closest2 = _mm_cvtsd_f64(_mm_min_sd(nearest2, _mm_unpackhi_pd(nearest2, nearest2)));
  return {any(flat), closest2 < quality.min_length2,
          _mm_cvtsd_f64(_mm_max_sd(farthest2, _mm_unpackhi_pd(farthest2, farthest2))), closest2};
}

}  // namespace weft
