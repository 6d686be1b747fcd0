// SPDX-License-Identifier: Apache-2.0
#include "engine/size/gradation/hull.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace weft {

Hull::Hull(std::vector<Point> points) {
  std::sort(points.begin(), points.end(),
            [](Point a, Point b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  const auto turns_left = [](Point a, Point b, Point c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0;
  };
  std::vector<Point> ring;  // counter-clockwise, the first point again at the end
  const auto add = [&](Point p, std::size_t least) {
    while (ring.size() > least && !turns_left(ring[ring.size() - 2], ring.back(), p))
      ring.pop_back();
    ring.push_back(p);
  };
  for (const Point p : points) add(p, 1);
  const std::size_t lower = ring.size();
  for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], lower);
  std::vector<std::pair<double, std::size_t>> lengths;
  for (std::size_t i = 0; i + 1 < ring.size(); ++i)
    lengths.emplace_back(-std::sqrt(distance2(ring[i], ring[i + 1])), i);
  std::sort(lengths.begin(), lengths.end());
  lengths.resize(std::min(lengths.size(), kMaxSides));
  for (const auto& [length, i] : lengths) {
    const Point normal{(ring[i + 1].y - ring[i].y) / -length, (ring[i + 1].x - ring[i].x) / length};
    // Taken over all corners of the hull, so that the rounding of the tests above does not matter.
    double reach = -std::numeric_limits<double>::infinity();
    for (const Point p : ring) reach = std::max(reach, normal.x * p.x + normal.y * p.y);
    sides_.push_back({normal, reach});
  }
}

bool Hull::misses(const Box& box) const {
  constexpr double kSlack = 1e-9;  // more than the rounding below
  const double slack = kSlack * (std::fabs(box.min_x) + std::fabs(box.max_x) +
                                 std::fabs(box.min_y) + std::fabs(box.max_y));
  return std::any_of(sides_.begin(), sides_.end(), [&](const Side& side) {
    const double x = side.normal.x > 0 ? box.min_x : box.max_x;
    const double y = side.normal.y > 0 ? box.min_y : box.max_y;
    return side.normal.x * x + side.normal.y * y > side.reach + slack;
  });
}

}  // namespace weft
