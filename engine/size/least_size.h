// SPDX-License-Identifier: Apache-2.0
// The least of several sizes, each with all that it is made of; NaN where one of them is.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "engine/size/size_function.h"
#include "engine/size/size_spec.h"

namespace weft {

class LeastSize final : public SizeFunction {
 public:
  // REQUIRES: at least one.
  explicit LeastSize(std::vector<Size> parts) : parts_(std::move(parts)) {}

  void evaluate(std::size_t n, const double* x, const double* y,
                double* out) const noexcept override {
    for (std::size_t i = 0; i < n; i += kLanes) {
      parts_[0].function().evaluate(kLanes, x + i, y + i, out + i);
      for (std::size_t part = 1; part < parts_.size(); ++part) {
        alignas(64) std::array<double, kLanes> other;
        parts_[part].function().evaluate(kLanes, x + i, y + i, other.data());
        for (std::size_t lane = 0; lane < kLanes; ++lane)
          if (!(other[lane] >= out[i + lane] || std::isnan(out[i + lane])))
            out[i + lane] = other[lane];
      }
    }
  }
  Interval bounds(const Box& box) const noexcept override {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Interval least{kInfinity, kInfinity, false};
    for (const Size& part : parts_) {
      const Interval of_part = part.function().bounds(box);
      if (of_part.lo > of_part.hi) return kUndefined;
      least = {std::min(least.lo, of_part.lo), std::min(least.hi, of_part.hi),
               least.may_be_nan || of_part.may_be_nan};
    }
    return least;
  }
  double edge_steepness(const Box& box) const noexcept override {
    return steepest(box, &SizeFunction::edge_steepness);
  }
  double steepness(const Box& box) const noexcept override {
    return steepest(box, &SizeFunction::steepness);
  }
  // Of the part that is no size there, if there is one.
  Asked asked_at(Point p) const override {
    for (const Size& part : parts_) {
      Asked asked = part.function().asked_at(p);
      if (!(asked.value > 0)) return asked;
    }
    return {(*this)(p)};
  }
  std::size_t bytes() const noexcept override {
    std::size_t sum = 0;
    for (const Size& part : parts_) sum += part.bytes();
    return sum;
  }
  std::size_t operations() const noexcept override {
    std::size_t sum = 0;
    for (const Size& part : parts_) sum += part.function().operations() + 4;
    return sum;
  }

 private:
  // Of the parts that may be the least somewhere in the box.
  double steepest(const Box& box,
                  double (SizeFunction::*of)(const Box&) const noexcept) const noexcept {
    const double highest = bounds(box).hi;
    double steepness = 0;
    for (const Size& part : parts_)
      if (!(part.function().bounds(box).lo > highest))
        steepness = std::max(steepness, (part.function().*of)(box));
    return steepness;
  }

  std::vector<Size> parts_;
};

}  // namespace weft
