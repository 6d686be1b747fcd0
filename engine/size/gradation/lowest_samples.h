// SPDX-License-Identifier: Apache-2.0
// Points of the domain whose size is known, and those whose cones are lowest at a place. The cone
// of a sample q is h(q) + G |p - q| (source_tree.h).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "engine/base/geometry.h"

namespace weft {

// A point of the domain and the length of edges there.
struct SizeSample {
  Point p;
  double edge = std::numeric_limits<double>::infinity();
  // The longest edge at the corners of a box and in the middles of its sides; infinity if the
  // domain does not hold all of the box.
  double highest = std::numeric_limits<double>::infinity();
  bool bad = false;  // negative or NaN, which no size may be
};

// A sample that may lie below all of a box. If its box was divided at the last level, samples of
// the children may lie lower still.
struct LowSample {
  SizeSample sample;
  std::uint32_t slot = kNone;  // of its box, at its level

  // The largest height of its cone in a box.
  double highest_in(const Box& box, double gradation) const {
    const double dx = std::max(sample.p.x - box.min_x, box.max_x - sample.p.x);
    const double dy = std::max(sample.p.y - box.min_y, box.max_y - sample.p.y);
    return sample.edge + gradation * std::sqrt(dx * dx + dy * dy);
  }
};

struct LowSamples {
  static constexpr std::size_t kMax = 6;
  std::array<LowSample, kMax> best;
  std::size_t count = 0;

  // Whether the cone of one of them is below `edge` all over the box.
  bool below(double edge, const Box& box, double gradation) const {
    return std::ranges::any_of(std::span(best).first(count), [&](const LowSample& low) {
      return low.highest_in(box, gradation) < edge;
    });
  }
};

// The samples whose cones are lowest at a point, sorted.
class LowestSamples {
 public:
  LowestSamples(Point at, double gradation) : at_(at), gradation_(gradation) {}

  void add(const LowSample& low) {
    const double height = low.sample.edge + gradation_ * std::sqrt(distance2(at_, low.sample.p));
    if (!(height < std::numeric_limits<double>::infinity())) return;
    std::size_t place = found_.count;
    while (place > 0 && height < heights_[place - 1]) --place;
    if (place == LowSamples::kMax) return;
    found_.count = std::min(found_.count + 1, LowSamples::kMax);
    for (std::size_t i = found_.count - 1; i > place; --i) {
      found_.best[i] = found_.best[i - 1];
      heights_[i] = heights_[i - 1];
    }
    found_.best[place] = low;
    heights_[place] = height;
  }
  const LowSamples& found() const { return found_; }

 private:
  Point at_;
  double gradation_;
  LowSamples found_;
  std::array<double, LowSamples::kMax> heights_{};
};

}  // namespace weft
