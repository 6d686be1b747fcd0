// SPDX-License-Identifier: Apache-2.0
#include "engine/size/vanishing_size.h"

#include <cmath>
#include <cstddef>

namespace weft {
namespace {

// Parts of the way from the segment to the centroid of the triangle beside it.
constexpr double kNear = 0x1p-12;
constexpr double kNearer = 0x1p-20;
// Places along a piece of a segment, so that a size which is 0 at one of them alone is not meant.
constexpr double kPlaces[] = {0.5, 0.25, 0.6875};

Point between(Point p, Point q, double part) {
  return {p.x + part * (q.x - p.x), p.y + part * (q.y - p.y)};
}

// From p on a side with this direction towards q: at most the square of the distance, and falling
// as fast as that.
bool falls_as_the_square(const SizeFunction& size, Point p, Point direction, Point q) {
  constexpr double kSlack = 1 + 1e-6;
  constexpr double kSquareOfParts = (kNearer / kNear) * (kNearer / kNear);
  const double distance = kNear * (direction.x * (q.y - p.y) - direction.y * (q.x - p.x)) /
                          std::sqrt(direction.x * direction.x + direction.y * direction.y);
  const double near = size(between(p, q, kNear));
  const double nearer = size(between(p, q, kNearer));
  return near >= 0 && near <= distance * distance && nearer >= 0 &&
         nearer <= near * kSquareOfParts * kSlack;
}

// On the side from a to b of a triangle with this centroid.
bool vanishes(const SizeFunction& size, Point a, Point b, Point centroid, double resolved) {
  for (const double place : kPlaces) {
    const Point p = between(a, b, place);
    const double value = size(p);
    if (!(value >= 0 && value < resolved)) return false;
    if (!falls_as_the_square(size, p, {b.x - a.x, b.y - a.y}, centroid)) return false;
  }
  return true;
}

}  // namespace

Result<std::optional<Point>> find_vanishing(const SizeFunction& size, const Domain& domain,
                                            double resolved, const ExecutionContext& context) {
  constexpr std::size_t kPollInterval = 1 << 10;
  Box box;
  for (const Point p : domain.vertices) box.add(p);
  if (size.bounds(box).lo > resolved) return std::nullopt;
  for (std::size_t i = 0; i < domain.triangles.size(); ++i) {
    if (i % kPollInterval == 0) {
      if (auto error = context.poll()) return tl::unexpected(std::move(*error));
    }
    const Domain::Triangle& t = domain.triangles[i];
    for (unsigned k = 0; k < 3; ++k) {
      if (t.subsegment[k] == kNone) continue;
      const Point a = domain.vertices[t.vertex[(k + 1) % 3]];
      const Point b = domain.vertices[t.vertex[(k + 2) % 3]];
      const Point c = centroid(a, b, domain.vertices[t.vertex[k]]);
      if (vanishes(size, a, b, c, resolved)) return between(a, b, 0.5);
    }
  }
  return std::nullopt;
}

}  // namespace weft
