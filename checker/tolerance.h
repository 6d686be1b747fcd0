// SPDX-License-Identifier: Apache-2.0
// What "on a segment" means. Steiner points and crossings are rounded to doubles, so they lie
// beside their segment, by half a unit in the last place each time that a piece is halved; and a
// segment may be bent to pass through a vertex nearby (gaps.h).
#pragma once

#include <algorithm>
#include <cmath>

#include "checker/domain.h"

namespace weft::check {

// A point within this distance of a segment lies on it: 32 * 2^-53 times the largest coordinate of
// the domain, in absolute value.
inline double on_segment_tolerance(const Domain& domain) {
  double largest = 0;
  for (const Vec2 p : domain.points) largest = std::max({largest, std::fabs(p.x), std::fabs(p.y)});
  return 32 * 0x1p-53 * largest;
}

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
