// SPDX-License-Identifier: GPL-3.0-or-later
// What the kernel asks of a grading function: the bounds on the areas of a ring of new triangles.
// The kernel is a template over this, so that a constant costs nothing.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "engine/geometry.h"
#include "engine/refine/cavity.h"
#include "engine/refine/quality_bounds.h"

namespace weft {

// A point where the size field is not finite or not positive.
struct BadSize {
  Point at;
  double value;
};

// A sentence that names the point.
std::string bad_size_message(const BadSize& bad);

// The same bound everywhere; infinity is no bound.
class ConstantArea {
 public:
  explicit ConstantArea(double bound) : doubled_(2 * bound) {}

  // Judges the triangles first <= i < last of the ring around p, none of which may exceed
  // `region_bound`.
  RingVerdict judge(const Ring& ring, std::uint32_t first, std::uint32_t last, Point,
                    double region_bound, const QualityBounds& quality, std::uint32_t* badness) {
    return judge_ring(ring, first, last, quality,
                      UniformAreaBound{std::min(doubled_, 2 * region_bound)},
                      std::numeric_limits<double>::infinity(), badness);
  }

  // Insertions that take about 0.1 ms, see ExecutionContext.
  static constexpr std::uint32_t poll_interval() { return 512; }

  // The bound at n points.
  void bounds_at(std::size_t n, const double*, const double*, double* bound) const {
    std::fill_n(bound, n, 0.5 * doubled_);
  }

  const std::optional<BadSize>& bad_size() const { return bad_size_; }

 private:
  double doubled_;
  std::optional<BadSize> bad_size_;
};

}  // namespace weft
