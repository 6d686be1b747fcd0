// SPDX-License-Identifier: Apache-2.0
// A size that no edge is to exceed on some lines, and that grows evenly away from them: the length
// of edges is at most `edge` + growth * (distance to the lines), and that of the size beneath.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "engine/size/fields/distance_field.h"
#include "engine/size/size_function.h"

namespace weft {

class LineSize final : public SizeFunction {
 public:
  // REQUIRES: `size` outlives this; edge > 0 and growth > 0, both finite.
  LineSize(const SizeFunction& size, DistanceField distance, double edge, double growth)
      : size_(&size), distance_(std::move(distance)), edge_(edge), growth_(growth) {}

  void evaluate(std::size_t n, const double* x, const double* y,
                double* out) const noexcept override {
    size_->evaluate(n, x, y, out);
    alignas(64) std::array<double, kLanes> distance;
    for (std::size_t i = 0; i < n; i += kLanes) {
      distance_.evaluate(kLanes, x + i, y + i, distance.data());
      for (std::size_t lane = 0; lane < kLanes; ++lane)
        out[i + lane] = least(out[i + lane], distance[lane]);
    }
  }
  Interval bounds(const Box& box) const noexcept override {
    const Interval size = size_->bounds(box);
    const Interval distance = distance_.bounds(box);
    return {least(size.lo, distance.lo), least(size.hi, distance.hi), size.may_be_nan};
  }
  double edge_steepness(const Box& box) const noexcept override {
    return std::max(size_->edge_steepness(box), growth_);
  }
  double steepness(const Box& box) const noexcept override {
    const double longest = edge_ + growth_ * distance_.bounds(box).hi;
    return std::max(size_->steepness(box), 2 * area_of_edge(1) * longest * growth_);
  }
  Asked asked_at(Point p) const override { return size_->asked_at(p); }
  std::size_t bytes() const noexcept override { return distance_.bytes(); }
  std::size_t operations() const noexcept override {
    return size_->operations() + distance_.operations() + 5;
  }

 private:
  // NaN if the size is.
  double least(double size, double distance) const {
    const double from_lines = area_of_edge(edge_ + growth_ * distance);
    return from_lines < size ? from_lines : size;
  }

  const SizeFunction* size_;
  DistanceField distance_;
  double edge_;
  double growth_;
};

}  // namespace weft
