// SPDX-License-Identifier: Apache-2.0
// A size that leaves room for a number of triangles across the domain where it is narrow: no edge
// is longer than the local width divided by that number.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "engine/size/fields/width_field.h"
#include "engine/size/size_function.h"

namespace weft {

class WidthSize final : public SizeFunction {
 public:
  // REQUIRES: `size` outlives this; cells > 0.
  WidthSize(const SizeFunction& size, WidthField width, double cells)
      : size_(&size), width_(std::move(width)), cells_(cells) {}

  void evaluate(std::size_t n, const double* x, const double* y,
                double* out) const noexcept override {
    size_->evaluate(n, x, y, out);
    alignas(64) std::array<double, kLanes> width;
    for (std::size_t i = 0; i < n; i += kLanes) {
      width_.evaluate(kLanes, x + i, y + i, width.data());
      for (std::size_t lane = 0; lane < kLanes; ++lane)
        out[i + lane] = least(out[i + lane], width[lane]);
    }
  }
  Interval bounds(const Box& box) const noexcept override {
    const Interval size = size_->bounds(box);
    const Interval width = width_.bounds(box);
    return {least(size.lo, width.lo), least(size.hi, width.hi), size.may_be_nan};
  }
  double edge_steepness(const Box& box) const noexcept override {
    return std::max(size_->edge_steepness(box), width_.steepness(box) / cells_);
  }
  double steepness(const Box& box) const noexcept override {
    const double widest = width_.bounds(box).hi / cells_;
    return std::max(size_->steepness(box),
                    2 * area_of_edge(1) * widest * width_.steepness(box) / cells_);
  }
  Asked asked_at(Point p) const override { return size_->asked_at(p); }
  std::size_t bytes() const noexcept override { return width_.bytes(); }
  std::size_t operations() const noexcept override {
    return size_->operations() + width_.operations() + 4;
  }

 private:
  // NaN if the size is.
  double least(double size, double width) const {
    const double across = area_of_edge(width / cells_);
    return across < size ? across : size;
  }

  const SizeFunction* size_;
  WidthField width_;
  double cells_;
};

}  // namespace weft
