// SPDX-License-Identifier: Apache-2.0
// Angles as numbers that rise with them, made of correctly rounded operations alone: the same on
// every machine, as those of the mathematical library are not.
#pragma once

#include <cmath>

#include "engine/base/geometry.h"

namespace weft {

// Of the angle at v from the direction to p, counter-clockwise to the direction to q: 0 for 0, 1
// for 90 degrees, 2 for 180, up to 4.
inline double turn(Point p, Point v, Point q) {
  const double px = p.x - v.x, py = p.y - v.y;
  const double qx = q.x - v.x, qy = q.y - v.y;
  const double cosine = (px * qx + py * qy) / std::sqrt((px * px + py * py) * (qx * qx + qy * qy));
  return px * qy - py * qx >= 0 ? 1 - cosine : 3 + cosine;
}

// The same for the angle between the directions, at most 180 degrees.
inline double turn_between(Point p, Point v, Point q) {
  const double left = turn(p, v, q);
  return left <= 2 ? left : 4 - left;
}

inline constexpr double kTurn60 = 0.5;                  // 1 - cos
inline constexpr double kTurn45 = 0.29289321881345254;  // 1 - cos
inline constexpr double kTurn35 = 0.18084795571100820;  // 1 - cos

}  // namespace weft
