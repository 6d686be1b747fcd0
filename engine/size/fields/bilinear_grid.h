// SPDX-License-Identifier: Apache-2.0
// Values at the nodes of a grid, bilinear between them: the value and the slope at a point, and
// their bounds over boxes. The one implementation behind RasterSize and RasterField.
//
// Node (i, j) is at (origin.x + i * dx, origin.y + j * dy). In the cell that holds a point, with t
// and s from 0 to 1 its place along x and y,
//   low = a + t (b - a), high = c + t (d - c), value = low + s (high - low),
// a, b the lower nodes and c, d the upper ones; never beyond the least and the largest of the four.
// A cell owns its left and its lower side. The gradient is that of this formula in the same cell.
//
// Outside::kNearest: outside the grid the value is that of its nearest point.
// Outside::kUndefined: it is NaN there, but for half a cell beside the grid, where it is that of
// the nearest point: the nodes of a picture are the middles of its pixels, and its pixels are all
// of it. It is NaN in each cell with a node that is NaN, too.
//
// Thread-safety: immutable once built. The values stay with the caller, where they are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "engine/base/context.h"
#include "engine/base/geometry.h"
#include "engine/size/fields/block_pyramid.h"
#include "engine/size/interval.h"
#include "weft/error.h"

namespace weft {

enum class Outside : std::uint8_t { kNearest, kUndefined };

// REQUIRES: origin, dx and dy finite, dx and dy positive; columns and rows positive.
struct GridShape {
  Point origin;  // of the first node
  double dx = 0;
  double dy = 0;
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;
};

template <class T, Outside kOutside>
class BilinearGrid {
 public:
  // `values` by rows from the lowest: that of node (i, j) is [j * columns + i]. REQUIRES: columns *
  // rows of them; none infinite, and none NaN if kOutside is kNearest.
  BilinearGrid(const GridShape& shape, std::span<const T> values)
      : shape_(shape), values_(values.data()) {}

  // Once, before `bounds` and before `slope_bounds`. Errors: those of context.poll.
  std::optional<Error> build_bounds(const ExecutionContext& context);
  std::optional<Error> build_slope_bounds(const ExecutionContext& context);

  void evaluate(std::size_t n, const double* x, const double* y, double* out) const noexcept;
  // The length of the gradient; infinite beyond 1e154.
  void evaluate_slope(std::size_t n, const double* x, const double* y, double* out) const noexcept;

  // Bit for bit of what `evaluate` and `evaluate_slope` return. Over at most kAtATime cells each
  // way as tight as rounding allows, beyond that from the extremes of blocks.
  Interval bounds(const Box& box) const noexcept;
  Interval slope_bounds(const Box& box) const noexcept;

  // What both builds take.
  static std::uint64_t bytes_to_build(std::uint32_t columns, std::uint32_t rows) {
    return BlockPyramid::bytes_for(columns, rows) +
           BlockPyramid::bytes_for(last_cell(columns) + 1, last_cell(rows) + 1);
  }

  // Of the bounds; the values are not counted.
  std::size_t bytes() const noexcept { return nodes_.bytes() + cells_.bytes(); }

 private:
  static constexpr std::uint32_t kAtATime = BlockPyramid::kAtATime;

  // Where a coordinate lies among the nodes: between `node` and `next`, at `t`; on which side of
  // where there are values, -1 or 1, or 0 within.
  struct Place {
    std::uint32_t node;
    std::uint32_t next;
    double t;
    int side;
  };
  struct Places {
    Place left, right, bottom, top;
    bool few;      // at most kAtATime cells each way
    bool inside;   // all of the box
    bool outside;  // all of the box
  };

  // A grid that ends somewhere has its last nodes in its last cells; if it goes on as it ends, they
  // have cells of their own.
  static constexpr std::uint32_t last_cell(std::uint32_t count) noexcept {
    return kOutside == Outside::kUndefined && count > 1 ? count - 2 : count - 1;
  }
  static Place place(double coordinate, double origin, double step, std::uint32_t count) noexcept;
  Place place_x(double x) const noexcept {
    return place(x, shape_.origin.x, shape_.dx, shape_.columns);
  }
  Place place_y(double y) const noexcept {
    return place(y, shape_.origin.y, shape_.dy, shape_.rows);
  }
  Places places(const Box& box) const noexcept;

  const T* row(std::uint32_t j) const noexcept { return values_ + std::size_t{j} * shape_.columns; }
  double node(std::uint32_t i, std::uint32_t j) const noexcept { return row(j)[i]; }
  double value(const Place& x, const Place& y) const noexcept;
  double slope(const Place& x, const Place& y) const noexcept;
  // Of the value at the corners of what a box cuts out of the cells.
  Interval at_corners(const Places& box) const noexcept;

  // Of nodes, and of the slope in cells; ranges with both ends.
  Interval node_extremes(std::uint32_t i0, std::uint32_t i1, std::uint32_t j0,
                         std::uint32_t j1) const noexcept;
  Interval cell_extremes(std::uint32_t i0, std::uint32_t i1, std::uint32_t j0,
                         std::uint32_t j1) const noexcept;
  void add_cell(std::uint32_t i, std::uint32_t j, Interval t, Interval s,
                Interval& to) const noexcept;

  GridShape shape_;
  const T* values_;
  BlockPyramid nodes_;
  BlockPyramid cells_;  // of the slope
};

extern template class BilinearGrid<double, Outside::kNearest>;
extern template class BilinearGrid<float, Outside::kUndefined>;

}  // namespace weft
