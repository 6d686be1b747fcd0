// SPDX-License-Identifier: Apache-2.0
// A field of values on a grid, bilinear between its nodes (bilinear_grid.h). Values may be
// negative, zero, or NaN for no data. The field is undefined (NaN) in every cell with a node that
// is NaN, and more than half a cell outside the grid; within that, its value is that of the nearest
// point.
//
//   FieldRaster raster{{0, 0}, 1, 1, 2, 2, {-1, 2, 3, 4}};
//   auto depth = RasterField::make(std::move(raster), "size.fields[0].raster", context);
//   double value = (*depth)({0.5, 0.5});             // 2
//   Interval range = depth->bounds({0, 0, 1, 0.5});  // from -1 to 3, or a little more
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/context.h"
#include "engine/size/field.h"
#include "engine/size/fields/bilinear_grid.h"
#include "weft/error.h"
#include "weft/size.h"

namespace weft {

class RasterField final : public Field {
  using Grid = BilinearGrid<float, Outside::kUndefined>;

 public:
  // `path` is that of the raster in the request. REQUIRES: origin, dx and dy are finite, dx and dy
  // positive; columns * rows values, one at least. Errors: kBadSizeValue with the field
  // "PATH.values[i]" for the first value that is infinite; those of the context. Same bits on any
  // number of threads.
  static Result<RasterField> make(FieldRaster raster, const std::string& path,
                                  const ExecutionContext& context);

  void evaluate(std::size_t n, const double* x, const double* y,
                double* out) const noexcept override {
    grid_.evaluate(n, x, y, out);
  }
  Interval bounds(const Box& box) const noexcept override { return grid_.bounds(box); }
  double steepness(const Box& box) const noexcept override {
    return std::max(0.0, grid_.slope_bounds(box).hi);
  }
  // Jumps from cell to cell.
  std::unique_ptr<const Field> slope() const override;
  std::size_t bytes() const noexcept override;
  std::size_t operations() const noexcept override { return 64; }

  // What `make` takes at most, the raster itself not counted.
  static std::uint64_t bytes_to_make(std::uint32_t columns, std::uint32_t rows) {
    return Grid::bytes_to_build(columns, rows);
  }

 private:
  explicit RasterField(FieldRaster raster);

  FieldRaster raster_;
  Grid grid_;  // refers to the values, which stay where they are when the raster moves
};

}  // namespace weft
