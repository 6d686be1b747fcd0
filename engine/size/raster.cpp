// SPDX-License-Identifier: Apache-2.0
#include "engine/size/raster.h"
#include "weft/weft.h"

#include <cmath>
#include <string>

#include "engine/base/context.h"
#include "engine/base/text.h"

namespace weft {

std::optional<Error> check_raster_values(std::span<const double> values, std::uint32_t columns) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double value = values[i];
    if (value > 0 && std::isfinite(value)) continue;
    const std::string field = "size.raster.values[" + std::to_string(i) + "]";
    return Error{ErrorCode::kBadSizeValue, field,
                 field + " is " + text(value) + ", at column " + std::to_string(i % columns) +
                     " of row " + std::to_string(i / columns) +
                     "; a size must be positive and finite"};
  }
  return std::nullopt;
}

RasterSize::RasterSize(const Raster& raster)
    : raster_(&raster),
      grid_({raster.origin, raster.dx, raster.dy, raster.columns, raster.rows}, raster.values) {}

Result<RasterSize> RasterSize::make(const Raster& raster) {
  if (auto error = check_raster_values(raster.values, raster.columns))
    return tl::unexpected(*error);
  RasterSize size(raster);
  const ExecutionContext unbounded;
  if (auto error = size.grid_.build_bounds(unbounded)) return tl::unexpected(*error);
  if (auto error = size.grid_.build_slope_bounds(unbounded)) return tl::unexpected(*error);
  return size;
}

std::size_t RasterSize::bytes() const noexcept {
  return raster_->values.capacity() * sizeof(double) + grid_.bytes();
}

}  // namespace weft
