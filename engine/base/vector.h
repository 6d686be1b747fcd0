// SPDX-License-Identifier: Apache-2.0
// Differences of points.
#pragma once

#include <cmath>

#include "engine/base/geometry.h"

namespace weft {

struct Vector {
  double x, y;
};

inline Vector operator-(Point p, Point q) {
  return {p.x - q.x, p.y - q.y};
}
inline Vector operator-(Vector v) {
  return {-v.x, -v.y};
}
inline double dot(Vector u, Vector v) {
  return u.x * v.x + u.y * v.y;
}
inline double cross(Vector u, Vector v) {
  return u.x * v.y - u.y * v.x;
}
inline double length(Vector u) {
  return std::sqrt(dot(u, u));
}

}  // namespace weft
