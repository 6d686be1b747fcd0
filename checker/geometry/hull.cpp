// SPDX-License-Identifier: Apache-2.0
#include "checker/geometry/hull.h"

#include <algorithm>
#include <array>

#include "checker/geometry/predicates.h"

namespace weft::check {
namespace {

// Whether the segments a-b and c-d have a point in common.
bool segments_meet(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  const int c_side = orientation(a, b, c), d_side = orientation(a, b, d);
  const int a_side = orientation(c, d, a), b_side = orientation(c, d, b);
  if (c_side == 0 && d_side == 0) return box_of(a, b).meets(box_of(c, d));
  return c_side * d_side <= 0 && a_side * b_side <= 0;
}

// The cone at a corner of a hull: between the chord and the tangent there.
struct Cone {
  Vec2 at, along, beyond;

  // Whether it holds the direction from its apex to p.
  bool holds(Vec2 p) const {
    const int turn = orientation(at, along, beyond);
    return turn * orientation(at, along, p) >= 0 && turn * orientation(at, p, beyond) >= 0;
  }
};

Cone cone_at(const Hull& hull, Vec2 end) {
  return {end, end == hull.from ? hull.to : hull.from, hull.corner};
}

bool is_end(const Hull& hull, Vec2 p) {
  return p == hull.from || p == hull.to;
}

bool covers(const Hull& hull, Vec2 p) {
  const std::array<int, 3> sides{orientation(hull.from, hull.to, p),
                                 orientation(hull.to, hull.corner, p),
                                 orientation(hull.corner, hull.from, p)};
  const auto [least, most] = std::minmax_element(sides.begin(), sides.end());
  return *least >= 0 || *most <= 0;
}

}  // namespace

Box box_of(const Hull& hull) {
  Box box = box_of(hull.from, hull.to);
  box.add(box_of(hull.corner, hull.corner));
  return box;
}

bool holds(const Hull& hull, Vec2 p) {
  return !is_end(hull, p) && covers(hull, p);
}

bool meet(const Hull& hull, Vec2 a, Vec2 b) {
  if (is_end(hull, a) && is_end(hull, b)) return false;
  if (is_end(hull, a)) return cone_at(hull, a).holds(b);
  if (is_end(hull, b)) return cone_at(hull, b).holds(a);
  return covers(hull, a) || segments_meet(a, b, hull.from, hull.to) ||
         segments_meet(a, b, hull.to, hull.corner) || segments_meet(a, b, hull.corner, hull.from);
}

bool meet(const Hull& hull, const Hull& other) {
  const bool from = is_end(hull, other.from), to = is_end(hull, other.to);
  if (from && to) return false;
  if (from || to) {
    const Vec2 end = from ? other.from : other.to;
    const Cone cone = cone_at(hull, end), others = cone_at(other, end);
    return cone.holds(others.along) || cone.holds(others.beyond) || others.holds(cone.along) ||
           others.holds(cone.beyond);
  }
  return covers(other, hull.from) || meet(hull, other.from, other.to) ||
         meet(hull, other.to, other.corner) || meet(hull, other.corner, other.from);
}

}  // namespace weft::check
