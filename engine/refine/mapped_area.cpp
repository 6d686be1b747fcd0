// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/refine/mapped_area.h"

#include <cmath>

namespace weft {

void MappedArea::find_place(const Ring& ring, std::uint32_t first, std::uint32_t last, Point p) {
  double reach2 = 0;
  for (std::uint32_t i = first; i <= last; ++i) reach2 = std::max(reach2, ring.length2[i]);
  const double reach = std::sqrt(reach2);
  const Box around{p.x - reach, p.y - reach, p.x + reach, p.y + reach};
  const bool same = place_.node != nullptr && place_.node->leaf() &&
                    around.min_x >= place_.box.min_x && around.max_x <= place_.box.max_x &&
                    around.min_y >= place_.box.min_y && around.max_y <= place_.box.max_y;
  if (!same) [[unlikely]]
    place_ = map_.locate(around);
}

RingVerdict MappedArea::judge_evaluated(const Ring& ring, std::uint32_t first, std::uint32_t last,
                                        Point p, double region_bound, const QualityBounds& quality,
                                        std::uint32_t* badness) {
  const std::uint32_t n = last - first;
  const std::size_t lanes = (n + Expression::kLanes - 1) / Expression::kLanes;
  if (lanes > x_.size()) {
    x_.resize(lanes);
    y_.resize(lanes);
    bound_.resize(lanes);
  }
  double* const x = x_.data()->values;
  double* const y = y_.data()->values;
  double* const bound = bound_.data()->values;
  for (std::uint32_t i = 0; i < n; ++i) {
    x[i] = p.x + (ring.x[first + i] + ring.x[first + i + 1]) * (1.0 / 3);
    y[i] = p.y + (ring.y[first + i] + ring.y[first + i + 1]) * (1.0 / 3);
  }
  // Lanes beyond n are evaluated, too: give them a point of the domain.
  for (std::uint32_t i = n; i % Expression::kLanes != 0; ++i) {
    x[i] = x[0];
    y[i] = y[0];
  }
  size_.evaluate(n, x, y, bound);

  const SizeMap::Node& node = *place_.node;
  if (node.may_be_nan || !(node.lo > 0) || !(node.hi < std::numeric_limits<double>::infinity())) {
    for (std::uint32_t i = 0; i < n; ++i) {
      if (!(bound[i] > 0 && bound[i] < std::numeric_limits<double>::infinity()) && !bad_size_) {
        bad_size_ = BadSize{{x[i], y[i]}, bound[i]};
      }
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) bound[i] = 2 * std::min(bound[i], region_bound);

  struct EvaluatedBound {
    const double* doubled;
    std::uint32_t first;
    double operator[](std::uint32_t i) const { return doubled[i - first]; }
  };
  const RingVerdict verdict =
      judge_ring(ring, first, last, quality, EvaluatedBound{bound, first}, badness);
  if (node.leaf()) return verdict;
  for (std::uint32_t i = first; i < last; ++i) {
    const double area = 0.5 * ring.cross[i];
    if (badness[i] == static_cast<std::uint32_t>(Badness::kLarge) ||
        !(area > SizeMap::kFeatureFactor * node.lowest_hi)) {
      continue;
    }
    const Point corners[3] = {
        p, {p.x + ring.x[i], p.y + ring.y[i]}, {p.x + ring.x[i + 1], p.y + ring.y[i + 1]}};
    if (map_.covers_finer(place_, corners, area)) {
      badness[i] = static_cast<std::uint32_t>(Badness::kLarge);
    }
  }
  return verdict;
}

void MappedArea::bounds_at(std::size_t n, const double* x, const double* y, double* bound) {
  Box around;
  for (std::size_t i = 0; i < n; ++i) around.add({x[i], y[i]});
  const SizeMap::Node& node = *map_.locate(around).node;
  if (node.constant()) {
    std::fill_n(bound, n, node.lo);
  } else {
    size_.evaluate(n, x, y, bound);
  }
}

}  // namespace weft
