// SPDX-License-Identifier: Apache-2.0
// A share of another size.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "engine/size/size_function.h"

namespace weft {

class ScaledSize final : public SizeFunction {
 public:
  // REQUIRES: `size` outlives this; share > 0 and finite.
  ScaledSize(const SizeFunction& size, double share) : size_(&size), share_(share) {}

  void evaluate(std::size_t n, const double* x, const double* y,
                double* out) const noexcept override {
    size_->evaluate(n, x, y, out);
    for (std::size_t i = 0; i < n; ++i) out[i] *= share_;
  }
  Interval bounds(const Box& box) const noexcept override {
    const Interval size = size_->bounds(box);
    return {share_ * size.lo, share_ * size.hi, size.may_be_nan};
  }
  double steepness(const Box& box) const noexcept override {
    return share_ * size_->steepness(box);
  }
  Asked asked_at(Point p) const override { return size_->asked_at(p); }
  std::size_t bytes() const noexcept override { return size_->bytes(); }
  std::size_t operations() const noexcept override { return size_->operations() + 1; }

 private:
  const SizeFunction* size_;
  double share_;
};

}  // namespace weft
