// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/refine/mapped_area.h"

#include <array>
#include <cmath>

namespace weft {

RingVerdict MappedArea::judge_elsewhere(const Ring& ring, std::uint32_t first, std::uint32_t last,
                                        Point p, double region_bound, const QualityBounds& quality,
                                        std::uint32_t* badness) {
  double reach2 = 0;
  for (std::uint32_t i = first; i <= last; ++i) reach2 = std::max(reach2, ring.length2[i]);
  const double reach = std::sqrt(reach2);
  const auto around = [&](double radius) {
    return Box{p.x - radius, p.y - radius, p.x + radius, p.y + radius};
  };
  const SizeMap::Place place = map_.locate(around(reach));
  const auto size = map_.uniform_size(place, around(reach));
  if (!size) {
    return judge_evaluated(place, ring, first, last, p, region_bound, quality, badness);
  }
  // The larger the box, the longer it serves; 30 % of the rings would leave the map's own boxes.
  size_ = *size;
  box_ = around(reach);
  for (const double factor : {6, 36}) {
    if (!map_.uniform_size(around(factor * reach))) break;
    box_ = around(factor * reach);
  }
  return judge_ring(ring, first, last, quality, UniformAreaBound{2 * std::min(size_, region_bound)},
                    std::numeric_limits<double>::infinity(), badness);
}

RingVerdict MappedArea::judge_evaluated(const SizeMap::Place& place, const Ring& ring,
                                        std::uint32_t first, std::uint32_t last, Point p,
                                        double region_bound, const QualityBounds& quality,
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
  expression_.evaluate(n, x, y, bound);

  const SizeMap::Node& node = *place.node;
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
  const RingVerdict verdict = judge_ring(ring, first, last, quality, EvaluatedBound{bound, first},
                                         std::numeric_limits<double>::infinity(), badness);
  if (node.leaf()) return verdict;
  for (std::uint32_t i = first; i < last; ++i) {
    const double area = 0.5 * ring.cross[i];
    if (badness[i] == static_cast<std::uint32_t>(Badness::kLarge) ||
        !(area > SizeMap::kFeatureFactor * node.lowest_hi)) {
      continue;
    }
    const std::array<Point, 3> corners{p, Point{p.x + ring.x[i], p.y + ring.y[i]},
                                       Point{p.x + ring.x[i + 1], p.y + ring.y[i + 1]}};
    if (map_.covers_finer(place, corners, area)) {
      badness[i] = static_cast<std::uint32_t>(Badness::kLarge);
    }
  }
  return verdict;
}

void MappedArea::bounds_at(std::size_t n, const double* x, const double* y, double* bound) {
  Box around;
  for (std::size_t i = 0; i < n; ++i) around.add({x[i], y[i]});
  if (const auto size = map_.uniform_size(around)) {
    std::fill_n(bound, n, *size);
  } else {
    expression_.evaluate(n, x, y, bound);
  }
}

}  // namespace weft
