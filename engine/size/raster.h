// SPDX-License-Identifier: Apache-2.0
// The grading function as a raster: values at the nodes of a grid, bilinear between them
// (fields/bilinear_grid.h), and outside the grid those of its nearest point.
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

#include "engine/size/fields/bilinear_grid.h"
#include "engine/size/size_function.h"
#include "weft/error.h"
#include "weft/size.h"

namespace weft {

class RasterSize final : public SizeFunction {
 public:
  // REQUIRES: the raster stays where it is; origin, dx and dy are finite, dx and dy positive;
  // columns * rows values, one at least. Errors: those of check_raster_values.
  static Result<RasterSize> make(const Raster& raster);

  void evaluate(std::size_t n, const double* x, const double* y,
                double* out) const noexcept override {
    grid_.evaluate(n, x, y, out);
  }
  Interval bounds(const Box& box) const noexcept override { return grid_.bounds(box); }
  double steepness(const Box& box) const noexcept override { return grid_.slope_bounds(box).hi; }
  std::size_t operations() const noexcept override { return 64; }

  // Of the raster, too.
  std::size_t bytes() const noexcept override;

  // What `make` takes at most for each value, the raster itself not counted: reached by a raster of
  // one row or one column. A square one takes one byte.
  static constexpr std::uint64_t kBytesPerValue = 16;

 private:
  explicit RasterSize(const Raster& raster);

  const Raster* raster_;
  BilinearGrid<double, Outside::kNearest> grid_;
};

}  // namespace weft
