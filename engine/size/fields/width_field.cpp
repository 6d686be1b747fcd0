// SPDX-License-Identifier: Apache-2.0
#include "engine/size/fields/width_field.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/size/fields/medial_axis.h"

namespace weft {
namespace {

double length(Point a, Point b) {
  return std::sqrt(distance2(a, b));
}

// The least distance at a point of the line from a to b. Along the line the distance changes no
// faster than the point moves; the line is halved until that bounds the distance to within kTight,
// or kDepth times. It is known at the ends.
double least_distance(const DistanceField& field, const Line& line, double at_a, double at_b,
                      int depth = 0) {
  constexpr double kTight = 0.98;
  constexpr int kDepth = 5;
  const double least = 0.5 * (at_a + at_b - length(line.a, line.b));
  if (depth == kDepth || least >= kTight * std::min(at_a, at_b)) return least;
  const Point middle{0.5 * (line.a.x + line.b.x), 0.5 * (line.a.y + line.b.y)};
  const double at_middle = field(middle);
  return std::min(least_distance(field, {line.a, middle}, at_a, at_middle, depth + 1),
                  least_distance(field, {middle, line.b}, at_middle, at_b, depth + 1));
}

}  // namespace

Result<WidthField> WidthField::make(const Domain& domain, const ExecutionContext& context) {
  Result<MedialAxis> axis = medial_axis(domain, context);
  if (!axis) return tl::unexpected(std::move(axis).error());
  Box box;
  for (const Line& wall : axis->walls) box.add(wall.a);
  // Each of the two fields announces its own bytes only.
  const std::uint64_t lines = axis->walls.size() + axis->axis.size();
  if (auto error = context.need_bytes(domain.bytes() + DistanceField::bytes_to_make(lines, 2),
                                      "the local width"))
    return tl::unexpected(*std::move(error));
  Result<DistanceField> to_walls = DistanceField::make(std::move(axis->walls), box, context);
  if (!to_walls) return tl::unexpected(std::move(to_walls).error());
  Result<DistanceField> to_axis = DistanceField::make(std::move(axis->axis), box, context);
  if (!to_axis) return tl::unexpected(std::move(to_axis).error());
  return WidthField(*std::move(to_walls), *std::move(to_axis), box);
}

WidthField::WidthField(DistanceField to_walls, DistanceField to_axis, const Box& box)
    : to_walls_(std::move(to_walls)),
      to_axis_(std::move(to_axis)),
      most_(std::min(box.width(), box.height())) {
  // More than the rounding of all coordinates.
  const double rounding =
      1e-13 * std::max({std::fabs(box.min_x), std::fabs(box.max_x), std::fabs(box.min_y),
                        std::fabs(box.max_y), box.width(), box.height()});
  std::vector<double> radii;
  for (const Line& line : to_axis_.lines())
    radii.push_back(least_distance(to_walls_, line, to_walls_(line.a), to_walls_(line.b)) -
                    rounding);
  radii_ = to_axis_.with_leasts(std::move(radii));
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
  const auto [axis, radius] = to_axis_.near(radii_, box);
  return {std::max(width(walls.lo, axis.lo), std::min(2 * radius, most_)), width(walls.hi, axis.hi),
          walls.may_be_nan || axis.may_be_nan};
}

}  // namespace weft
