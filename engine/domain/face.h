// SPDX-License-Identifier: Apache-2.0
// The faces of the triangulation (triangulation.h), and when one cannot stay.
#pragma once

#include <cstdint>

#include "engine/base/geometry.h"
#include "engine/domain/triangulation/filtered.h"

namespace weft {

// A half-edge is `face << 2 | edge`. Edge i of a face is opposite its vertex i; a face outside the
// convex hull has one vertex kNone, which stands for infinity.
struct Face {
  std::uint32_t vertex[3];
  std::uint32_t neighbor[3];  // half-edges
};

// An edge of a cavity's border: the vertex where it starts, counter-clockwise around the cavity,
// and the half-edge behind it.
struct Border {
  std::uint32_t from;
  std::uint32_t outside;
};

inline constexpr int ccw(int i) {
  return i == 2 ? 0 : i + 1;
}
inline constexpr int cw(int i) {
  return i == 0 ? 2 : i - 1;
}

// For p on the line through a and b: whether it lies strictly between them.
inline bool between(Point a, Point b, Point p) {
  return a.x != b.x ? (a.x < p.x) == (p.x < b.x) && p.x != a.x && p.x != b.x
                    : (a.y < p.y) == (p.y < b.y) && p.y != a.y && p.y != b.y;
}

// For a, b, c and p on one circle: whether p counts as inside. The point that is raised most, the
// last in lexicographic order, decides. If it is p, p is outside. Otherwise p is inside if and only
// if p and that point are on the same side of the line through the other two; p is never on it.
inline bool inside_when_raised(Point a, Point b, Point c, Point p) {
  const auto before = [](Point q, Point r) { return q.x < r.x || (q.x == r.x && q.y < r.y); };
  Point last = p;
  for (const Point q : {a, b, c})
    if (before(last, q)) last = q;
  if (last == p) return false;
  if (last == a) return orientation(p, b, c) > 0;
  if (last == b) return orientation(a, p, c) > 0;
  return orientation(a, b, p) > 0;
}

// Whether the face cannot stay if p becomes a vertex. An infinite face can, unless p sees its hull
// edge from outside, or lies on it. `points` are those of the vertices.
inline bool conflicts(const Face& face, const Point* points, Point p) {
  const std::uint32_t a = face.vertex[0], b = face.vertex[1], c = face.vertex[2];
  if (c == kNone || b == kNone || a == kNone) [[unlikely]] {
    const int i = a == kNone ? 0 : b == kNone ? 1 : 2;
    const Point q = points[face.vertex[ccw(i)]], r = points[face.vertex[cw(i)]];
    const int side = orientation(q, r, p);
    return side > 0 || (side == 0 && between(q, r, p));
  }
  const Point q = points[a], r = points[b], s = points[c];
  const int side = in_circle(q, r, s, p);
  if (side != 0) [[likely]]
    return side > 0;
  return inside_when_raised(q, r, s, p);
}

}  // namespace weft
