// SPDX-License-Identifier: Apache-2.0
#include "engine/size/fields/width_field.h"

#include <algorithm>
#include <cstdint>

#include "engine/size/fields/medial_axis.h"

namespace weft {

Result<WidthField> WidthField::make(const Domain& domain, const ExecutionContext& context) {
  Result<MedialAxis> axis = medial_axis(domain, context);
  if (!axis) return tl::unexpected(std::move(axis).error());
  Box box;
  for (const Line& wall : axis->walls) box.add(wall.a);
  // Either of the fields announces its own bytes only.
  const std::uint64_t lines = axis->walls.size() + axis->axis.size();
  if (auto error = context.need_bytes(domain.bytes() + DistanceField::kBytesPerLine * lines +
                                      2 * DistanceField::kBytesBesides))
    return tl::unexpected(*std::move(error));
  Result<DistanceField> to_walls = DistanceField::make(std::move(axis->walls), box, context);
  if (!to_walls) return tl::unexpected(std::move(to_walls).error());
  Result<DistanceField> to_axis = DistanceField::make(std::move(axis->axis), box, context);
  if (!to_axis) return tl::unexpected(std::move(to_axis).error());
  return WidthField(*std::move(to_walls), *std::move(to_axis), std::min(box.width(), box.height()));
}

void WidthField::evaluate(std::size_t n, const double* x, const double* y,
                          double* out) const noexcept {
  constexpr std::size_t kAtATime = 32 * kLanes;
  alignas(64) double to_axis[kAtATime];
  for (std::size_t first = 0; first < n; first += kAtATime) {
    const std::size_t count = std::min(n - first, kAtATime);
    to_walls_.evaluate(count, x + first, y + first, out + first);
    to_axis_.evaluate(count, x + first, y + first, to_axis);
    for (std::size_t i = 0; i < count; ++i) out[first + i] = width(out[first + i], to_axis[i]);
  }
}

Interval WidthField::bounds(const Box& box) const noexcept {
  const Interval walls = to_walls_.bounds(box);
  const Interval axis = to_axis_.bounds(box);
  return {width(walls.lo, axis.lo), width(walls.hi, axis.hi), walls.may_be_nan || axis.may_be_nan};
}

}  // namespace weft
