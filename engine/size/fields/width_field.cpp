// SPDX-License-Identifier: Apache-2.0
#include "engine/size/fields/width_field.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "engine/size/fields/medial_axis.h"

namespace weft {
namespace {

double length(Point a, Point b) {
  return std::sqrt(distance2(a, b));
}

Point middle(const Line& line) {
  return {0.5 * (line.a.x + line.b.x), 0.5 * (line.a.y + line.b.y)};
}

// The distances at some points, many at a time.
std::vector<double> distances(const DistanceField& field, const std::vector<Point>& at) {
  constexpr std::size_t kAtATime = 32 * Field::kLanes;
  alignas(64) double x[kAtATime], y[kAtATime], distance[kAtATime];
  std::vector<double> all;
  all.reserve(at.size());
  for (std::size_t first = 0; first < at.size(); first += kAtATime) {
    const std::size_t count = std::min(at.size() - first, kAtATime);
    for (std::size_t i = 0; i < kAtATime; ++i) {
      const Point p = at[first + std::min(i, count - 1)];
      x[i] = p.x;
      y[i] = p.y;
    }
    field.evaluate(kAtATime, x, y, distance);
    all.insert(all.end(), distance, distance + count);
  }
  return all;
}

// For each line, the least distance at a point of it, or less. Along a line the distance changes no
// faster than the point moves; a line is halved until that bounds the distance to within kTight, or
// kDepth times.
Result<std::vector<double>> least_distances(const DistanceField& field,
                                            const std::vector<Line>& lines,
                                            const ExecutionContext& context) {
  constexpr double kTight = 0.98;
  constexpr int kDepth = 5;
  struct Part {
    Line line;
    double at_a;
    double at_b;
    std::size_t of;
  };
  std::vector<double> least(lines.size(), std::numeric_limits<double>::infinity());
  std::vector<Part> parts;
  std::vector<Point> at;
  for (const Line& line : lines) at.insert(at.end(), {line.a, line.b});
  std::vector<double> found = distances(field, at);
  for (std::size_t i = 0; i < lines.size(); ++i)
    parts.push_back({lines[i], found[2 * i], found[2 * i + 1], i});
  for (int depth = 0; !parts.empty(); ++depth) {
    if (auto error = context.poll()) return tl::unexpected(*std::move(error));
    std::vector<Part> wide;
    for (const Part& part : parts) {
      const double bound = 0.5 * (part.at_a + part.at_b - length(part.line.a, part.line.b));
      if (depth == kDepth || bound >= kTight * std::min(part.at_a, part.at_b))
        least[part.of] = std::min(least[part.of], bound);
      else
        wide.push_back(part);
    }
    at.clear();
    for (const Part& part : wide) at.push_back(middle(part.line));
    found = distances(field, at);
    parts.clear();
    for (std::size_t i = 0; i < wide.size(); ++i) {
      const auto& [line, at_a, at_b, of] = wide[i];
      parts.push_back({{line.a, at[i]}, at_a, found[i], of});
      parts.push_back({{at[i], line.b}, found[i], at_b, of});
    }
  }
  return least;
}

}  // namespace

Result<WidthField> WidthField::make(const Domain& domain, const ExecutionContext& context) {
  Result<MedialAxis> axis = medial_axis(domain, context);
  if (!axis) return tl::unexpected(std::move(axis).error());
  const Result<DomainCover> cover = DomainCover::make(domain, context);
  if (!cover) return tl::unexpected(cover.error());
  // Each of the two fields announces its own bytes only.
  const std::uint64_t lines = axis->walls.size() + axis->axis.size();
  if (auto error = context.need_bytes(domain.bytes() + DistanceField::bytes_to_make(lines, 2),
                                      "the local width"))
    return tl::unexpected(*std::move(error));
  Result<DistanceField> to_walls = DistanceField::make(std::move(axis->walls), *cover, context);
  if (!to_walls) return tl::unexpected(std::move(to_walls).error());
  Result<DistanceField> to_axis = DistanceField::make(std::move(axis->axis), *cover, context);
  if (!to_axis) return tl::unexpected(std::move(to_axis).error());
  auto radii = least_distances(*to_walls, to_axis->lines(), context);
  if (!radii) return tl::unexpected(std::move(radii).error());
  return WidthField(*std::move(to_walls), *std::move(to_axis), *std::move(radii), cover->box());
}

WidthField::WidthField(DistanceField to_walls, DistanceField to_axis, std::vector<double> radii,
                       const Box& box)
    : to_walls_(std::move(to_walls)),
      to_axis_(std::move(to_axis)),
      most_(std::min(box.width(), box.height())) {
  // More than the rounding of all coordinates.
  const double rounding =
      1e-13 * std::max({std::fabs(box.min_x), std::fabs(box.max_x), std::fabs(box.min_y),
                        std::fabs(box.max_y), box.width(), box.height()});
  for (double& radius : radii) radius -= rounding;
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
