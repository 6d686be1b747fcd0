// SPDX-License-Identifier: Apache-2.0
// Finds the triangles that may hold a point, faster than their tree: a quadtree whose leaves list
// the triangles whose boxes meet them, in ascending order of their numbers. So the first in a list
// that holds a point is the one with the lowest number of all that do.
//
// A point's cell of the last level never falls as a coordinate grows, so a point in a triangle's
// box lies in a leaf that lists the triangle, whatever rounding does.
//
// Where lists stay long (many slivers at one vertex, copies), a leaf has none. A subtree lists no
// more than its share of kListedPerTriangle entries for each triangle, so the memory and time to
// build are bounded for any triangles. Thread-safety: immutable once built.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/context.h"
#include "engine/base/geometry.h"
#include "engine/size/fields/triangle_tree.h"
#include "weft/error.h"

namespace weft {

class TriangleCells {
 public:
  // The same on any number of threads. Errors: those of the context.
  std::optional<Error> build(const TriangleTree& tree, const ExecutionContext& context);

  // The places of the triangles that may hold p; nullopt if they are too many to be listed.
  std::optional<std::span<const std::uint32_t>> near(Point p) const noexcept {
    const std::uint32_t x = column(p.x);
    const std::uint32_t y = row(p.y);
    const int below = kMaxDepth - top_levels_;
    std::uint32_t at = table_[(y >> below) << top_levels_ | x >> below];
    for (int bit = below - 1; nodes_[at].count == kInner; --bit)
      at = nodes_[at].first + ((x >> bit & 1) | (y >> bit & 1) << 1);
    const Node node = nodes_[at];
    if (node.count == kTooMany) return std::nullopt;
    return std::span(lists_.data() + node.first, node.count);
  }

  std::size_t bytes() const noexcept {
    return nodes_.capacity() * sizeof(Node) +
           (lists_.capacity() + table_.capacity()) * sizeof(std::uint32_t);
  }
  // What the cells of n triangles take, and the peak while they are built.
  static std::uint64_t bytes_to_build(std::uint64_t n) { return 150 * n + 65536; }

 private:
  friend class CellBuilder;

  static constexpr int kMaxDepth = 22;
  static constexpr int kMaxTopLevels = 8;
  static constexpr std::uint32_t kInner = 0xffffffffu;
  static constexpr std::uint32_t kTooMany = 0xfffffffeu;

  struct Node {
    std::uint32_t first = 0;         // of its four children, or of its list
    std::uint32_t count = kTooMany;  // of its list, or kInner, or kTooMany
  };

  static std::uint32_t cell(double from_least, double per_unit) {
    constexpr double kLast = (1u << kMaxDepth) - 1;
    // 0 for a NaN
    return static_cast<std::uint32_t>(std::min(std::max(0.0, from_least * per_unit), kLast));
  }
  std::uint32_t column(double x) const { return cell(x - box_.min_x, cells_per_unit_); }
  std::uint32_t row(double y) const { return cell(y - box_.min_y, cells_per_unit_); }
  void fill_table(std::uint32_t node, int depth, std::uint32_t ix, std::uint32_t iy);

  Box box_;  // of all triangles; the root is a square that holds it
  double cells_per_unit_ = 0;
  int top_levels_ = 0;       // that the table skips
  std::vector<Node> nodes_;  // the root first
  std::vector<std::uint32_t> lists_;
  std::vector<std::uint32_t> table_;  // node of each cell of a level, or the leaf above it
};

}  // namespace weft
