// SPDX-License-Identifier: Apache-2.0
// What the engine computes of points and boxes everywhere.
#pragma once

#include <algorithm>

#include "weft/geometry.h"

namespace weft {

inline double distance2(Point p, Point q) {
  return (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y);
}

inline Point centroid(Point a, Point b, Point c) {
  return {a.x + ((b.x - a.x) + (c.x - a.x)) * (1.0 / 3),
          a.y + ((b.y - a.y) + (c.y - a.y)) * (1.0 / 3)};
}

// How far p is from the border of a box; negative outside.
inline double room_in(const Box& box, Point p) {
  return std::min(std::min(p.x - box.min_x, box.max_x - p.x),
                  std::min(p.y - box.min_y, box.max_y - p.y));
}

}  // namespace weft
