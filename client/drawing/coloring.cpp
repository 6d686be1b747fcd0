// SPDX-License-Identifier: Apache-2.0
#include "client/drawing/coloring.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace weft::client {
namespace {

constexpr double kMinLog = -1080;  // the binary logarithm of the smallest double
constexpr double kMaxLog = 1024;
constexpr double kStepsPerOctave = 16;

}  // namespace

Coloring::Coloring(DrawColor by, DrawnUnit unit, AreaBound bound)
    : by_(by), unit_(unit), bound_(std::move(bound)) {
  if (by_ == DrawColor::kSize)
    area_at_.resize(static_cast<std::size_t>((kMaxLog - kMinLog) * kStepsPerOctave) + 1);
}

float Coloring::value(const DrawnTriangle& triangle) const {
  if (by_ == DrawColor::kAngle) return static_cast<float>(smallest_angle_deg(triangle, unit_));
  if (by_ == DrawColor::kBound) {
    constexpr double kMax = 1e6;
    const double bound = bound_(centroid(triangle));
    if (!(bound > 0)) return 0;
    return static_cast<float>(std::min(area(triangle, DrawnUnit::kNone) / bound, kMax));
  }
  const double size = std::max(area(triangle, unit_), std::numeric_limits<double>::denorm_min());
  return static_cast<float>(std::clamp(std::log2(size), kMinLog, kMaxLog));
}

void Coloring::note(float value, double weight) {
  constexpr float kRounding = 1e-6F;
  if (by_ == DrawColor::kBound) above_bound_ = above_bound_ || value > 1 + kRounding;
  if (area_at_.empty()) return;
  area_at_[static_cast<std::size_t>((double{value} - kMinLog) * kStepsPerOctave)] += weight;
}

void Coloring::note_region(std::int32_t region) {
  if (regions_.size() < kMaxRegions) regions_.insert(region);
}

ValueRange Coloring::range() const {
  if (by_ == DrawColor::kBound) return {0, above_bound_ ? 2.0 : 1.0};
  if (by_ != DrawColor::kSize) return {0, 60};
  constexpr double kLeftOut = 1e-3;
  double all = 0;
  for (const double area : area_at_) all += area;
  if (!(all > 0)) return {0, 1};
  const auto log_at = [](std::size_t step) {
    return kMinLog + static_cast<double>(step) / kStepsPerOctave;
  };
  std::size_t low = 0;
  for (double below = 0; (below += area_at_[low]) <= kLeftOut * all;) ++low;
  std::size_t high = area_at_.size() - 1;
  for (double above = 0; (above += area_at_[high]) <= kLeftOut * all;) --high;
  ValueRange range{log_at(low), log_at(high + 1)};
  if (const double missing = 1 - (range.high - range.low); missing > 0) {
    range.low -= missing / 2;
    range.high += missing / 2;
  }
  return range;
}

Color Coloring::color(float value, const ValueRange& range) {
  return viridis((double{value} - range.low) / (range.high - range.low));
}

}  // namespace weft::client
