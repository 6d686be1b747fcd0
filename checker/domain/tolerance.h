// SPDX-License-Identifier: Apache-2.0
// Defines "on a segment" and "merged". Steiner points and crossings are rounded to
// doubles, so they lie beside their segment, by half a unit in the last place each time that a
// piece is halved. Features of the domain that are nearer to each other than the merging distance T
// become one: a point may move onto another one, a segment may be bent to pass through a vertex
// nearby (near_features.h says which ones may, bent_domain.h how they are judged).
#pragma once

#include <algorithm>
#include <cmath>

#include "checker/domain.h"

namespace weft::check {

// In absolute value.
inline double largest_coordinate(const Domain& domain) {
  double largest = 0;
  for (const Vec2 p : domain.points) largest = std::max({largest, std::fabs(p.x), std::fabs(p.y)});
  return largest;
}

// A point within this distance of a segment lies on it: 32 * 2^-53 times the largest coordinate.
inline double on_segment_tolerance(const Domain& domain) {
  return 32 * 0x1p-53 * largest_coordinate(domain);
}

// T: Domain::snap, but at least 2^-40 times the largest coordinate.
inline double merging_distance(const Domain& domain) {
  return std::max(domain.snap, 0x1p-40 * largest_coordinate(domain));
}

// How far the chain of a segment may run from it, in units of T, if something bends it: an end may
// move by T, and each further vertex pulls a piece of the segment by at most T from its place.
inline constexpr double kMaxBend = 4;

// A face whose width is at most twice as many T may be missing after merging.
inline constexpr double kSliver = 2;

// A margin for distances that are compared with T, because the mesher and the checker round them.
inline constexpr double kMergingSlack = 0x1p-10;

// A directed segment, measured in more than double precision.
class Track {
 public:
  // REQUIRES: from != to.
  Track(Vec2 from, Vec2 to)
      : from_(from),
        x_(static_cast<long double>(to.x) - from.x),
        y_(static_cast<long double>(to.y) - from.y),
        length_(std::hypot(x_, y_)) {
    x_ /= length_;
    y_ /= length_;
  }
  double length() const { return static_cast<double>(length_); }
  // How far along the segment p is.
  double position(Vec2 p) const {
    return static_cast<double>((static_cast<long double>(p.x) - from_.x) * x_ +
                               (static_cast<long double>(p.y) - from_.y) * y_);
  }
  // From p to the nearest point of the segment.
  double distance(Vec2 p) const {
    const long double dx = static_cast<long double>(p.x) - from_.x;
    const long double dy = static_cast<long double>(p.y) - from_.y;
    const long double along = dx * x_ + dy * y_;
    const long double beyond = along < 0 ? along : along > length_ ? along - length_ : 0;
    return static_cast<double>(std::hypot(dx * y_ - dy * x_, beyond));
  }
  bool carries(Vec2 p, double tolerance) const {
    const long double dx = static_cast<long double>(p.x) - from_.x;
    const long double dy = static_cast<long double>(p.y) - from_.y;
    const long double along = dx * x_ + dy * y_;
    return std::fabs(dx * y_ - dy * x_) <= tolerance && along >= -tolerance &&
           along <= length_ + tolerance;
  }

 private:
  Vec2 from_;
  long double x_, y_, length_;
};

}  // namespace weft::check
