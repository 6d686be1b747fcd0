// SPDX-License-Identifier: Apache-2.0
// The plain types that every part of the engine uses.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

namespace weft {

// A point of the plane, in the units of the request's coordinates.
struct Point {
  double x = 0;
  double y = 0;
  friend bool operator==(const Point&, const Point&) = default;
};

inline double distance2(Point p, Point q) {
  return (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y);
}

inline Point centroid(Point a, Point b, Point c) {
  return {a.x + ((b.x - a.x) + (c.x - a.x)) * (1.0 / 3),
          a.y + ((b.y - a.y) + (c.y - a.y)) * (1.0 / 3)};
}

// A closed axis-parallel box. The default box is empty; `add` grows it.
struct Box {
  double min_x = std::numeric_limits<double>::infinity();
  double min_y = std::numeric_limits<double>::infinity();
  double max_x = -std::numeric_limits<double>::infinity();
  double max_y = -std::numeric_limits<double>::infinity();

  void add(Point p) {
    min_x = std::min(min_x, p.x);
    min_y = std::min(min_y, p.y);
    max_x = std::max(max_x, p.x);
    max_y = std::max(max_y, p.y);
  }
  void merge(const Box& other) {
    add(Point{other.min_x, other.min_y});
    add(Point{other.max_x, other.max_y});
  }
  double width() const { return max_x - min_x; }
  double height() const { return max_y - min_y; }
};

// How far p is from the border of a box; negative outside.
inline double room_in(const Box& box, Point p) {
  return std::min(std::min(p.x - box.min_x, box.max_x - p.x),
                  std::min(p.y - box.min_y, box.max_y - p.y));
}

// No vertex, no triangle, no segment.
inline constexpr std::uint32_t kNone = 0xffffffffu;

}  // namespace weft
