// SPDX-License-Identifier: Apache-2.0
// An arc of a circle between two points. In long double, and without the circle's centre, which
// is far away if the arc is nearly straight. Angles are those by which the arc turns from its
// start, in radians: 0 there, turn() at its end. Immutable, thread-safe.
#pragma once

#include "checker/domain.h"

namespace weft::check {

class CircularArc {
 public:
  // As Arc::bulge says. REQUIRES: from != to; a bulge that is not 0.
  CircularArc(Vec2 from, Vec2 to, double bulge);

  double turn() const { return static_cast<double>(turn_); }
  double radius() const;
  // From the circle to p; below 0 if p is inside.
  double distance(Vec2 p) const;
  // Of the point of the circle nearest to p: below 0 before the arc, above turn() behind it.
  double angle(Vec2 p) const;
  Vec2 at(double angle) const;
  Vec2 tangent(double angle) const;  // forward, of length 1

  // The area between the arc and its chord of this turn from p forward to q; above 0 if the arc
  // lies right of it.
  double beside(Vec2 p, Vec2 q, double turn) const;

  // The tangents in the ends of a chord of this turn, from p forward to q, meet in a point as high
  // over its middle as `height` says, on the side of the arc; `side` is that point with another
  // height.
  static double height(Vec2 p, Vec2 q, double turn);
  Vec2 side(Vec2 p, Vec2 q, double height) const;

 private:
  long double middle_x_, middle_y_, x_, y_;  // of the chord, and its direction
  long double half_;                         // of its length
  long double bulge_, sign_;                 // its magnitude, and 1 if the arc turns left, or -1
  long double turn_;
};

}  // namespace weft::check
