// SPDX-License-Identifier: Apache-2.0
// The one tolerance of a domain. Features nearer than T = merge_tolerance() are merged by the
// arrangement (arrangement.h); what is left is meshed within its bounds.
//
// T is the caller's Pslg::snap, but at least kMergeFraction of the largest absolute coordinate,
// 4,096 to 8,192 units in its last place: below that, double precision has no room to refine in.
// After merging, vertices are T apart, and half of the least tolerance at least off the segments of
// which they are not ends. Edges that the bounds then need are a fraction of that, and a small one
// where segments meet at small angles. Refinement makes no edge below kEdgeFraction of the largest
// coordinate, T / 64: 64 to 128 units in the last place, so rounding a Steiner point turns no edge
// by more than a hundredth.
// With these two, 500 rounded floor plans meet their bounds at 20, 30, 33 and 34 degrees.
//
// The largest coordinate counts, not the size of the feature or of the domain: the output is
// rounded to doubles, whose precision far from the origin depends on the coordinates.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/base/geometry.h"
#include "weft/pslg.h"

namespace weft {

inline constexpr double kMergeFraction = 0x1p-40;
inline constexpr double kEdgeFraction = 0x1p-46;

inline double largest_coordinate(const std::vector<Point>& points) {
  double largest = 0;
  for (const Point p : points) largest = std::max({largest, std::fabs(p.x), std::fabs(p.y)});
  return largest;
}

inline double least_tolerance(const Pslg& pslg) {
  return kMergeFraction * largest_coordinate(pslg.points);
}

inline double merge_tolerance(const Pslg& pslg) {
  return std::max(pslg.snap, least_tolerance(pslg));
}

}  // namespace weft
