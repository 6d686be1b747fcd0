// SPDX-License-Identifier: Apache-2.0
// The point of a segment that is nearest to another point. In long double, because a difference of
// coordinates may cancel.
#pragma once

#include <algorithm>
#include <cmath>

#include "checker/domain.h"

namespace weft::check {

struct NearestOnSegment {
  double distance = 0;
  double t = 0;  // from 0 at a to 1 at b
};

// `a` and `b` may be the same.
inline NearestOnSegment nearest_on_segment(Vec2 a, Vec2 b, Vec2 p) {
  const long double ux = static_cast<long double>(b.x) - a.x;
  const long double uy = static_cast<long double>(b.y) - a.y;
  const long double px = static_cast<long double>(p.x) - a.x;
  const long double py = static_cast<long double>(p.y) - a.y;
  const long double square = ux * ux + uy * uy;
  const long double t = square > 0 ? std::clamp((px * ux + py * uy) / square, 0.0L, 1.0L) : 0.0L;
  const long double dx = px - t * ux;
  const long double dy = py - t * uy;
  return {static_cast<double>(std::sqrt(dx * dx + dy * dy)), static_cast<double>(t)};
}

}  // namespace weft::check
