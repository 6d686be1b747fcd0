// SPDX-License-Identifier: Apache-2.0
// The grading function as a raster: values at the nodes of a grid, bilinear between them, and
// outside the grid those of its nearest point.
//
// Node (i, j) is at (origin.x + i * dx, origin.y + j * dy). In the cell that holds a point, with t
// and s from 0 to 1 its place along x and y,
//   low = a + t (b - a), high = c + t (d - c), value = low + s (high - low),
// a, b the lower nodes and c, d the upper ones; never beyond the least and the largest of the four.
//
//   const Raster raster{{0, 0}, 1, 1, 2, 2, {1, 2, 3, 4}};
//   Result<RasterSize> size = RasterSize::make(raster);
//   double bound = (*size)({0.5, 0.5});                  // 2.5
//   Interval least = size->bounds({0, 0, 1, 0.5});       // from 1 to 3, or a little more
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/error.h"
#include "engine/size/size_function.h"

namespace weft {

struct Raster {
  Point origin;  // of the first node
  double dx = 0;
  double dy = 0;
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;
  std::vector<double> values;  // by rows from the lowest: that of node (i, j) is [j * columns + i]
};

// kBadSizeValue with the field "size.raster.values[i]" for the first value that is not positive and
// finite.
std::optional<Error> check_raster_values(std::span<const double> values, std::uint32_t columns);

class RasterSize final : public SizeFunction {
 public:
  // REQUIRES: the raster stays where it is; origin, dx and dy are finite, dx and dy positive;
  // columns * rows values, one at least. Errors: those of check_raster_values.
  static Result<RasterSize> make(const Raster& raster);

  void evaluate(std::size_t n, const double* x, const double* y,
                double* out) const noexcept override;

  // From at most kAtATime cells each way as tight as rounding allows, beyond that from the least
  // and largest values of blocks of nodes.
  Interval bounds(const Box& box) const noexcept override;

  std::size_t operations() const noexcept override { return 64; }

  // Of the raster, too.
  std::size_t bytes() const noexcept override;

  // What `make` takes at most for each value, the raster itself not counted.
  static constexpr std::uint64_t kBytesPerValue = 16;

 private:
  static constexpr std::uint32_t kAtATime = 4;

  // Nodes in blocks of 2^level each way, with their least and largest values.
  struct Level {
    std::uint32_t columns;
    std::vector<Interval> blocks;
  };
  // Where a coordinate lies among the nodes: between `node` and `next`, at `t`.
  struct Place {
    std::uint32_t node;
    std::uint32_t next;
    double t;
  };

  explicit RasterSize(const Raster& raster) : raster_(&raster) {}
  void add_levels();
  static Place place(double coordinate, double origin, double step, std::uint32_t count) noexcept;
  double node(std::uint32_t i, std::uint32_t j) const noexcept;
  double value(const Place& x, const Place& y) const noexcept;
  // Of nodes, first and last included.
  Interval extremes(std::uint32_t i0, std::uint32_t i1, std::uint32_t j0,
                    std::uint32_t j1) const noexcept;

  const Raster* raster_;
  std::vector<Level> levels_;  // from blocks of two nodes each way up
};

}  // namespace weft
