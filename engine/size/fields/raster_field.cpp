// SPDX-License-Identifier: Apache-2.0
#include "engine/size/fields/raster_field.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/base/text.h"
#include "engine/size/fields/polled_loop.h"

namespace weft {
namespace {

class RasterSlope final : public Field {
 public:
  explicit RasterSlope(const BilinearGrid<float, Outside::kUndefined>& grid) : grid_(grid) {}

  void evaluate(std::size_t n, const double* x, const double* y,
                double* out) const noexcept override {
    grid_.evaluate_slope(n, x, y, out);
  }
  Interval bounds(const Box& box) const noexcept override { return grid_.slope_bounds(box); }
  std::size_t operations() const noexcept override { return 96; }

 private:
  const BilinearGrid<float, Outside::kUndefined>& grid_;
};

std::optional<Error> check_values(const FieldRaster& raster, const std::string& path,
                                  const ExecutionContext& context) {
  constexpr std::size_t kAtOnce = 1 << 18;
  const std::vector<float>& values = raster.values;
  // Per group, the index of the first value that is infinite; kAtOnce if there is none.
  std::vector<std::uint32_t> first((values.size() + kAtOnce - 1) / kAtOnce);
  const auto stop = polled_loop(context, first.size(), [&](std::size_t group) {
    const auto from = values.begin() + static_cast<std::ptrdiff_t>(group * kAtOnce);
    const auto to = values.begin() +
                    static_cast<std::ptrdiff_t>(std::min((group + 1) * kAtOnce, values.size()));
    const auto bad = std::find_if(from, to, [](float value) { return std::isinf(value); });
    first[group] = bad == to ? kAtOnce : static_cast<std::uint32_t>(bad - from);
  });
  if (stop) return stop;
  for (std::size_t group = 0; group < first.size(); ++group) {
    if (first[group] == kAtOnce) continue;
    const std::size_t i = group * kAtOnce + first[group];
    const std::string field = path + ".values[" + std::to_string(i) + "]";
    return Error{ErrorCode::kBadSizeValue, field,
                 field + " is " + text(values[i]) + ", at column " +
                     std::to_string(i % raster.columns) + " of row " +
                     std::to_string(i / raster.columns) +
                     "; a value must be finite, or NaN for no data"};
  }
  return std::nullopt;
}

}  // namespace

RasterField::RasterField(FieldRaster raster)
    : raster_(std::move(raster)),
      grid_({raster_.origin, raster_.dx, raster_.dy, raster_.columns, raster_.rows},
            raster_.values) {}

Result<RasterField> RasterField::make(FieldRaster raster, const std::string& path,
                                      const ExecutionContext& context) {
  if (auto error = check_values(raster, path, context)) return tl::unexpected(*error);
  const std::uint64_t held = raster.values.capacity() * sizeof(float);
  if (auto error = context.need_bytes(held + bytes_to_make(raster.columns, raster.rows),
                                      "a field of a raster"))
    return tl::unexpected(*error);
  RasterField field(std::move(raster));
  if (auto error = field.grid_.build_bounds(context)) return tl::unexpected(*error);
  if (auto error = field.grid_.build_slope_bounds(context)) return tl::unexpected(*error);
  return field;
}

std::unique_ptr<const Field> RasterField::slope() const {
  return std::make_unique<RasterSlope>(grid_);
}

std::size_t RasterField::bytes() const noexcept {
  return raster_.values.capacity() * sizeof(float) + grid_.bytes();
}

}  // namespace weft
