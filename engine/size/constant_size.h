// SPDX-License-Identifier: Apache-2.0
// The grading function that is the same everywhere; infinity for no bound.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>

#include "engine/size/size_function.h"

namespace weft {

class ConstantSize : public SizeFunction {
 public:
  explicit ConstantSize(double value) : value_(value) {}

  void evaluate(std::size_t n, const double*, const double*, double* out) const noexcept override {
    std::fill_n(out, n, value_);
  }
  Interval bounds(const Box&) const noexcept override { return {value_, value_, false}; }
  double steepness(const Box&) const noexcept override { return 0; }
  std::optional<double> constant() const noexcept override { return value_; }
  std::size_t operations() const noexcept override { return 1; }

 private:
  double value_;
};

}  // namespace weft
