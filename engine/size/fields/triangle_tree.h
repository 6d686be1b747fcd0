// SPDX-License-Identifier: Apache-2.0
// Finds triangles by place: the one that holds a point, the one nearest to a point, those that meet
// a box. The triangles may overlap, repeat and leave gaps.
//
// A packed tree of boxes (Kamel and Faloutsos, "On packing R-trees", 1993): triangles along the
// Hilbert curve of their centroids, in groups of four; four groups make an item of the next level,
// and so on. A place is a triangle's number along the curve. Every triangle is counter-clockwise.
//
// Laws: what holds a point, and which triangle is nearest, depends on the triangles alone, never on
// the tree. Points on a common edge of two triangles lie on the same side for both. Thread-safety:
// immutable once built. The vertices stay with the caller, where they are.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "engine/base/context.h"
#include "engine/base/geometry.h"
#include "weft/error.h"

namespace weft {

struct NumberedTriangle {
  std::array<std::uint32_t, 3> vertex;
  std::uint32_t number;  // in the caller's order
};

class TriangleTree {
 public:
  static constexpr std::uint32_t kFan = 4;

  // REQUIRES: triangles are counter-clockwise, 2^30 at most, one at least, in ascending order of
  // their numbers; coordinates are at most 1e50 in absolute value. Errors: those of context.poll.
  std::optional<Error> build(const std::vector<Point>& vertices,
                             std::vector<NumberedTriangle> triangles,
                             const ExecutionContext& context);

  const std::vector<NumberedTriangle>& triangles() const noexcept { return triangles_; }
  Point corner(std::uint32_t place, int k) const noexcept {
    return vertices_[triangles_[place].vertex[static_cast<std::size_t>(k)]];
  }
  const Box& box() const noexcept { return box_; }
  std::size_t bytes() const noexcept;
  // What a tree of n triangles takes, the triangles among it, and the peak while it is built.
  static std::uint64_t bytes_to_build(std::uint64_t n) { return 96 * n + 4096; }

  // Levels of items, from groups of triangles (level 0) to the one item that is all (levels() - 1).
  std::size_t levels() const noexcept { return quads_.size() + 1; }
  std::size_t items(std::size_t level) const noexcept {
    std::size_t n = triangles_.size();
    for (std::size_t k = 0; k <= level; ++k) n = (n + kFan - 1) / kFan;
    return n;
  }

  struct Found {
    std::uint32_t place = kNone;
    double distance2 = std::numeric_limits<double>::infinity();
    Point point{};           // of the triangle, nearest to what was asked for
    std::size_t visits = 0;  // items and triangles that were looked at
  };

  // Whether the triangle holds p, its border included.
  //
  // Tests the box, too: by rounding, a point beside a long triangle may seem to be inside, but the
  // tree does not search beyond the box.
  bool holds(std::uint32_t place, Point p) const noexcept {
    const auto& v = triangles_[place].vertex;
    if (side(v[0], v[1], p) < 0 || side(v[1], v[2], p) < 0 || side(v[2], v[0], p) < 0) return false;
    Box box;
    for (const std::uint32_t vertex : v) box.add(vertices_[vertex]);
    return room_in(box, p) >= 0;
  }
  // The triangle with the lowest number that holds p, its border included; kNone if none does.
  Found holding(Point p) const noexcept;
  // How many triangles hold p; two stands for more.
  int count_holding(Point p) const noexcept;
  // The triangle nearest to p, of several the one with the lowest number. REQUIRES: p is finite.
  Found nearest(Point p) const noexcept;

  // Covers all triangles that meet the box: with triangle(place) for each of a few, or item(level,
  // i) for all of an item. Looks at a bounded number of items.
  template <class TakeItem, class TakeTriangle>
  void cover(const Box& box, const TakeItem& item, const TakeTriangle& triangle) const;

  // Twice the area of (a, b, p), with the sign of its orientation; of the same magnitude for (b,
  // a).
  double side(std::uint32_t a, std::uint32_t b, Point p) const noexcept {
    const Point from = vertices_[std::min(a, b)];
    const Point to = vertices_[std::max(a, b)];
    const double doubled = (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x);
    return a > b ? -doubled : doubled;
  }

 private:
  static constexpr std::size_t kMaxLevels = 16;
  static constexpr std::size_t kMaxCovering = 64;  // items at a time

  // The boxes of four items, and the least number of a triangle in each.
  struct Quad {
    std::array<double, kFan> min_x, min_y, max_x, max_y;
    std::array<std::uint32_t, kFan> first;
  };
  struct Item {
    std::uint32_t level;
    std::uint32_t index;
  };
  // For a search from the root: at most kFan - 1 wait at each level, and kFan at the last.
  struct Stack {
    std::array<Item, kMaxLevels * kFan> items;
    std::size_t size = 0;
    void push(Item item) { items[size++] = item; }
    Item pop() { return items[--size]; }
  };

  Item root() const noexcept { return {static_cast<std::uint32_t>(quads_.size()), 0}; }
  template <class Take>
  std::size_t visit_holding(Point p, const std::uint32_t& below, const Take& take) const noexcept;
  void take_if_nearer(std::uint32_t place, Point p, Found& best) const noexcept;
  std::optional<Error> add_levels(const ExecutionContext& context);

  const Point* vertices_ = nullptr;
  std::vector<NumberedTriangle> triangles_;
  std::vector<std::vector<Quad>> quads_;  // [k]: of the items of level k
  Box box_;
};

inline bool meet(const Box& a, const Box& b) {
  return a.min_x <= b.max_x && b.min_x <= a.max_x && a.min_y <= b.max_y && b.min_y <= a.max_y;
}

template <class TakeItem, class TakeTriangle>
void TriangleTree::cover(const Box& box, const TakeItem& item, const TakeTriangle& triangle) const {
  std::array<std::uint32_t, kMaxCovering> now;
  std::array<std::uint32_t, kMaxCovering> next;
  std::size_t count = 1;
  now[0] = 0;
  for (std::size_t level = quads_.size(); level > 0; --level) {
    std::size_t found = 0;
    bool too_many = false;
    for (std::size_t n = 0; n < count && !too_many; ++n) {
      const Quad& quad = quads_[level - 1][now[n]];
      for (std::uint32_t k = 0; k < kFan; ++k) {
        const Box child{quad.min_x[k], quad.min_y[k], quad.max_x[k], quad.max_y[k]};
        if (!meet(child, box)) continue;
        if (child.min_x >= box.min_x && child.max_x <= box.max_x && child.min_y >= box.min_y &&
            child.max_y <= box.max_y) {
          item(level - 1, now[n] * kFan + k);
        } else if (found == kMaxCovering) {
          too_many = true;
        } else {
          next[found++] = now[n] * kFan + k;
        }
      }
    }
    if (too_many) {
      for (std::size_t n = 0; n < count; ++n) item(level, now[n]);
      return;
    }
    std::copy_n(next.begin(), found, now.begin());
    count = found;
  }
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t end = std::min<std::size_t>(now[n] * kFan + kFan, triangles_.size());
    for (std::size_t place = now[n] * kFan; place < end; ++place)
      triangle(static_cast<std::uint32_t>(place));
  }
}

}  // namespace weft
