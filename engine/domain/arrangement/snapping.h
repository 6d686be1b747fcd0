// SPDX-License-Identifier: Apache-2.0
// Distances that decide what is merged, never on which side something lies: rounded arithmetic,
// the same on every machine.
#pragma once

#include <cmath>

#include "engine/base/geometry.h"

namespace weft {

inline double distance(Point p, Point q) {
  return std::sqrt(distance2(p, q));
}

// REQUIRES: a and b differ.
inline double distance_to_line(Point p, Point a, Point b) {
  const double ux = b.x - a.x;
  const double uy = b.y - a.y;
  return std::fabs(ux * (p.y - a.y) - uy * (p.x - a.x)) / std::sqrt(ux * ux + uy * uy);
}

inline double distance_to_segment(Point p, Point a, Point b) {
  const double ux = b.x - a.x;
  const double uy = b.y - a.y;
  const double along = ux * (p.x - a.x) + uy * (p.y - a.y);
  if (along <= 0) return distance(p, a);
  if (along >= ux * ux + uy * uy) return distance(p, b);
  return distance_to_line(p, a, b);
}

}  // namespace weft
