// SPDX-License-Identifier: Apache-2.0
#include "client/drawing/drawn_triangle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "files/geo/lonlat_extent.h"

namespace weft::client {
namespace {

struct Side {
  double x = 0;
  double y = 0;
  double square() const { return x * x + y * y; }
};

// From each corner i to the next one, in the unit of lengths.
std::array<Side, 3> sides(const DrawnTriangle& triangle, DrawnUnit unit) {
  const auto& p = triangle.corners;
  double x_unit = 1;
  double y_unit = 1;
  if (unit == DrawnUnit::kDegrees) {
    y_unit = kMetresPerDegree;
    x_unit = y_unit * longitude_scale((p[0].y + p[1].y + p[2].y) / 3);
  }
  const auto side = [&](const Point& a, const Point& b) {
    return Side{(b.x - a.x) * x_unit, (b.y - a.y) * y_unit};
  };
  return {side(p[0], p[1]), side(p[1], p[2]), side(p[2], p[0])};
}

double cross(const Side& a, const Side& b) {
  return a.x * b.y - a.y * b.x;
}

}  // namespace

Point centroid(const DrawnTriangle& triangle) {
  const auto& p = triangle.corners;
  return {p[0].x / 3 + p[1].x / 3 + p[2].x / 3, p[0].y / 3 + p[1].y / 3 + p[2].y / 3};
}

double area(const DrawnTriangle& triangle, DrawnUnit unit) {
  const auto side = sides(triangle, unit);
  return std::abs(cross(side[0], side[1])) / 2;
}

double smallest_angle_deg(const DrawnTriangle& triangle, DrawnUnit unit) {
  const auto side = sides(triangle, unit);
  // The smallest angle lies opposite the shortest side.
  std::size_t shortest = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (side[i].square() < side[shortest].square()) shortest = i;
  const Side& a = side[(shortest + 1) % 3];
  const Side& b = side[(shortest + 2) % 3];
  const double along = -(a.x * b.x + a.y * b.y);
  const double across = std::abs(cross(a, b));
  if (!(across > 0)) return 0;
  return std::min(60.0, std::atan2(across, along) * 180 / std::numbers::pi);
}

}  // namespace weft::client
