// SPDX-License-Identifier: Apache-2.0
// Points and boxes of the plane, in the units of the request's coordinates.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

namespace weft {

struct Point {
  double x = 0;
  double y = 0;
  friend bool operator==(const Point&, const Point&) = default;
};

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

// An index that names nothing: no vertex, triangle, segment or area.
inline constexpr std::uint32_t kNone = 0xffffffffu;

}  // namespace weft
