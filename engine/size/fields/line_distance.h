// SPDX-License-Identifier: Apache-2.0
// The square of the distance from a point to a line: the one formula of every distance.
//
// With u = 2^-53, the root of the computed square is at most 16 u (d + 2 |b - a|) from the distance
// d to the line from a to a + (b - a), b - a rounded; whatever lies below is built on twice that.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/geometry.h"
#include "engine/base/simd.h"

namespace weft {

// From a to a + u. `inverse` is 1 / |u|^2, 0 for a point.
struct StraightLine {
  double ax;
  double ay;
  double ux;
  double uy;
  double inverse;

  // Drawn from left to right, so that a line has the same bits in both directions.
  static StraightLine between(Point a, Point b) {
    constexpr double kMinSquare = 0x1p-1000;  // what is shorter is a point
    if (b.x < a.x || (b.x == a.x && b.y < a.y)) std::swap(a, b);
    const double ux = b.x - a.x;
    const double uy = b.y - a.y;
    const double square = ux * ux + uy * uy;
    return {a.x, a.y, ux, uy, square > kMinSquare ? 1 / square : 0};
  }
  double square(Point p) const {
    const double wx = p.x - ax;
    const double wy = p.y - ay;
    double t = (wx * ux + wy * uy) * inverse;
    t = t > 0 ? t : 0;
    t = t < 1 ? t : 1;
    const double qx = wx - t * ux;
    const double qy = wy - t * uy;
    return qx * qx + qy * qy;
  }
  double length() const { return std::sqrt(ux * ux + uy * uy); }
  Point end() const { return {ax + ux, ay + uy}; }
  Point nearest(Point p) const {
    double t = ((p.x - ax) * ux + (p.y - ay) * uy) * inverse;
    t = std::min(std::max(t, 0.0), 1.0);
    return {ax + t * ux, ay + t * uy};
  }
};

// Lowers best[i] to StraightLine::square of two points, for i < kPairs.
template <int kPairs>
inline void take_nearer(const StraightLine& line, const __m128d* x, const __m128d* y,
                        __m128d* best) {
  const __m128d ax = _mm_set1_pd(line.ax);
  const __m128d ay = _mm_set1_pd(line.ay);
  const __m128d ux = _mm_set1_pd(line.ux);
  const __m128d uy = _mm_set1_pd(line.uy);
  const __m128d inverse = _mm_set1_pd(line.inverse);
  for (int i = 0; i < kPairs; ++i) {
    const __m128d wx = _mm_sub_pd(x[i], ax);
    const __m128d wy = _mm_sub_pd(y[i], ay);
    __m128d t = _mm_mul_pd(_mm_add_pd(_mm_mul_pd(wx, ux), _mm_mul_pd(wy, uy)), inverse);
    t = _mm_min_pd(_mm_max_pd(t, _mm_setzero_pd()), _mm_set1_pd(1));
    const __m128d qx = _mm_sub_pd(wx, _mm_mul_pd(t, ux));
    const __m128d qy = _mm_sub_pd(wy, _mm_mul_pd(t, uy));
    best[i] = _mm_min_pd(best[i], _mm_add_pd(_mm_mul_pd(qx, qx), _mm_mul_pd(qy, qy)));
  }
}

}  // namespace weft
