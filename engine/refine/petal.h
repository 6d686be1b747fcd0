// SPDX-License-Identifier: Apache-2.0
// Chooses a skinny triangle's Steiner point: the best of several places.
//
// The petal of the triangle's shortest edge is the disk from whose points, on the triangle's side,
// the edge is seen at the bound on angles or more (H. Erten and A. Üngör, "Quality triangulations
// with locally optimal Steiner points", 2009). On that side it lies in the triangle's circumdisk.
// So a point there removes the triangle, and the new triangle at the edge has an angle within the
// bound. The first place is the standard one (steiner_point.h), the others are on the petal's outer
// arc. The best place removes the most bad triangles: those in its cavity less those that its star
// would have. Among equal places, it is the one farthest from the vertices that it would be
// joined to.
//
// A place is admitted only if the vertices that it would be joined to are at least as far away as
// the shortest edge is long, so that no smaller distance arises (docs/termination.md). If a point
// at the standard place encroaches upon a segment, or this task may not insert it, then there is no
// search. Other places of that kind are left out. The search ends early if a place removes all bad
// triangles around.
//
// Five places on the arc make a third fewer triangles than the standard place alone at 33 degrees
// (bench/README.md). Segments are not split at the best of several places, because the proof in
// docs/termination.md needs the middle.
//
// Units: coordinates of the domain. Thread-safety: values.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "engine/base/geometry.h"
#include "engine/refine/quality_bounds.h"

namespace weft {

class Petal {
 public:
  // The petal of the triangle a, b, c. REQUIRES: the bound on angles is above 0.
  Petal(Point a, Point b, Point c, const QualityBounds& quality) {
    const double opposite_a = distance2(b, c);
    const double opposite_b = distance2(c, a);
    const double opposite_c = distance2(a, b);
    shortest2_ = std::min({opposite_a, opposite_b, opposite_c});
    const auto [from, to] = shortest2_ == opposite_a   ? std::pair(b, c)
                            : shortest2_ == opposite_b ? std::pair(c, a)
                                                       : std::pair(a, b);
    // In lengths of the edge: the radius, and the height of the centre over the edge's middle.
    const double radius = 0.5 / std::sqrt(quality.sin2);
    const double height = radius * std::sqrt(1 - quality.sin2);
    const double x = to.x - from.x;
    const double y = to.y - from.y;
    centre_ = {from.x + 0.5 * x - height * y, from.y + 0.5 * y + height * x};
    along_ = {kReach * radius * x, kReach * radius * y};
  }

  // Squared length of the triangle's shortest edge.
  double shortest2() const { return shortest2_; }

  // Whether two places are nearly the same.
  bool same_place(Point p, Point q) const { return distance2(p, q) < 0.01 * shortest2_; }

  // The place that is seen from the centre at an angle from the edge's bisector, given by the
  // tangent of half of it: -1 to 1 for the half that is away from the edge. No sine is needed, so
  // that no machine rounds otherwise.
  Point place(double half_tangent) const {
    const double scale = 1 / (1 + half_tangent * half_tangent);
    const double across = scale * 2 * half_tangent;
    const double up = scale * (1 - half_tangent * half_tangent);
    return {centre_.x + across * along_.x - up * along_.y,
            centre_.y + across * along_.y + up * along_.x};
  }

 private:
  static constexpr double kReach =
      0.99;  // fraction of the radius, so that rounding makes no angle too small

  double shortest2_;
  Point centre_;
  Point along_;  // the edge's direction, with the distance of the places from the centre as length
};

// Calls consider(half_tangent) for places of a petal; `consider` tells whether its place is the
// best one. Up to 34 degrees these are five: over the edge's middle, 65 degrees to both sides, and
// 35 degrees to both sides of the best one so far. Above they are 13 all over the arc: at 36
// degrees, 30 of 100 floor plans with rounded coordinates do not end with five, and all do with 13.
template <class F>
void search_petal(const QualityBounds& quality, F&& consider) {
  constexpr double kSteepSin2 = 0.3127;  // of 34 degrees
  if (quality.sin2 > kSteepSin2) {
    constexpr int kToOneSide = 6;
    for (int i = -kToOneSide; i <= kToOneSide; ++i) consider(i * (1.0 / kToOneSide));
    return;
  }
  constexpr double kAside = 0.64;
  double best = 0;
  const auto look_at = [&](double half_tangent) {
    if (consider(half_tangent)) best = half_tangent;
  };
  look_at(0);
  look_at(-kAside);
  look_at(kAside);
  const double middle = best;
  look_at(middle - 0.5 * kAside);
  look_at(middle + 0.5 * kAside);
}

}  // namespace weft
