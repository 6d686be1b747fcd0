// SPDX-License-Identifier: Apache-2.0
#include "checker/domain/gaps.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "checker/domain/tolerance.h"
#include "checker/geometry/box_tree.h"
#include "checker/geometry/predicates.h"

namespace weft::check {
namespace {

double unit_in_the_last_place(double value) {
  return std::nextafter(value, std::numeric_limits<double>::infinity()) - value;
}

}  // namespace

double snap_distance(Vec2 a, Vec2 b) {
  const double largest = std::max({std::fabs(a.x), std::fabs(a.y), std::fabs(b.x), std::fabs(b.y)});
  return kSnapUlps * unit_in_the_last_place(largest);
}

std::optional<Vec2> across(Vec2 p, Vec2 a, Vec2 b, double distance) {
  const int side = orientation(a, b, p);
  if (side == 0) return std::nullopt;
  // A distance is rounded, and a step of that length may be too short to change p.
  const double snap = std::max(distance, snap_distance(p, p));
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  // Towards the line: to the right of a-b if p is on its left.
  const double x = side * (b.y - a.y) / length, y = -side * (b.x - a.x) / length;
  for (double reach = snap; reach <= 64 * snap; reach *= 2) {
    const Vec2 q{p.x + reach * x, p.y + reach * y};
    if (orientation(a, b, q) != side) return q;
  }
  return std::nullopt;
}

std::vector<std::array<Vec2, 2>> links_across_gaps(const Domain& domain) {
  std::vector<Box> boxes;
  boxes.reserve(domain.segments.size());
  for (const auto [a, b] : domain.segments) {
    const Vec2 p = domain.points[a], q = domain.points[b];
    boxes.push_back(box_of(p, q).grown(snap_distance(p, q)));
  }
  const BoxTree tree(std::move(boxes));
  std::vector<std::array<Vec2, 2>> links;
  for (const Vec2 p : domain.points) {
    tree.visit(box_of(p, p), [&](std::uint32_t s) {
      const Vec2 a = domain.points[domain.segments[s][0]];
      const Vec2 b = domain.points[domain.segments[s][1]];
      if (p == a || p == b || orientation(a, b, p) == 0) return;
      const Track track(a, b);
      const double position = track.position(p), snap = snap_distance(a, b);
      if (position <= 0 || position >= track.length() || !track.carries(p, snap)) return;
      if (const std::optional<Vec2> q = across(p, a, b, snap)) links.push_back({p, *q});
    });
  }
  return links;
}

}  // namespace weft::check
