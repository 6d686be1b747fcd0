// SPDX-License-Identifier: GPL-3.0-or-later
// When a vertex is so near a segment that it counts as on it. Rounded arithmetic: these decide what
// meets what, never on which side something lies.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/domain/arrangement.h"
#include "engine/geometry.h"

namespace weft {

// kSnapUlps ulps of the largest coordinate of segment ab.
inline double snap_distance(Point a, Point b) {
  const double m = std::max({std::fabs(a.x), std::fabs(a.y), std::fabs(b.x), std::fabs(b.y)});
  return kSnapUlps * (std::nextafter(m, std::numeric_limits<double>::infinity()) - m);
}

inline double distance(Point p, Point q) {
  return std::max(std::fabs(p.x - q.x), std::fabs(p.y - q.y));
}

inline double distance_to_line(Point p, Point a, Point b) {
  const double ux = b.x - a.x;
  const double uy = b.y - a.y;
  return std::fabs(ux * (p.y - a.y) - uy * (p.x - a.x)) / std::sqrt(ux * ux + uy * uy);
}

// How far along segment ab p lies, up to a factor. One order for all vertices of the segment's
// chain: as each vertex that it is led through comes strictly between its neighbours, the chain
// never turns back and only so many vertices can be added.
inline double progress(Point p, Point a, Point b) {
  return (b.x - a.x) * (p.x - a.x) + (b.y - a.y) * (p.y - a.y);
}

}  // namespace weft
