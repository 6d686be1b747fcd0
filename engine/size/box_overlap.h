// SPDX-License-Identifier: Apache-2.0
// Boxes of a quadtree, and what they have in common with the triangles of a domain.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "engine/base/geometry.h"
#include "engine/domain/domain.h"

namespace weft {

using Corners = std::array<Point, 3>;

inline Corners corners_of(const Domain& domain, std::uint32_t t) {
  const auto& v = domain.triangles[t].vertex;
  return {domain.vertices[v[0]], domain.vertices[v[1]], domain.vertices[v[2]]};
}

inline Point middle(const Box& box) {
  return {box.min_x + 0.5 * (box.max_x - box.min_x), box.min_y + 0.5 * (box.max_y - box.min_y)};
}

inline double diagonal(const Box& box) {
  return std::sqrt(box.width() * box.width() + box.height() * box.height());
}

// In Morton order.
inline Box child_box(const Box& box, unsigned child) {
  const Point m = middle(box);
  return {child & 1 ? m.x : box.min_x, child & 2 ? m.y : box.min_y, child & 1 ? box.max_x : m.x,
          child & 2 ? box.max_y : m.y};
}

// Whether the open box and the counter-clockwise triangle have a point in common, by separating
// axes.
bool overlap(const Box& box, const Corners& c);

// Whether the box lies in the counter-clockwise triangle, away from its sides.
bool inside(const Box& box, const Corners& c);

// Whether the closed box and the segment from a to b have a point in common.
bool meets(const Box& box, Point a, Point b);

// The part of a triangle that lies in a box: Sutherland-Hodgman clipping.
struct CommonPart {
  std::array<Point, 8> corners;
  std::size_t count;
  double area() const;
};
CommonPart common_part(const Box& box, const Corners& c);

}  // namespace weft
