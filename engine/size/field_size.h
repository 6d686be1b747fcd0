// SPDX-License-Identifier: Apache-2.0
// A size beneath a length of edges that follows a field: edges are at most
//   base + growth * field / parts
// long. With the distance to some lines, none is longer than `base` there, and the bound grows
// evenly away from them; with the width of the domain, there is room for `parts` of them across it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/size/size_function.h"

namespace weft {

struct EdgesByField {
  double base = 0;
  double growth = 1;
  double parts = 1;
};

class FieldSize final : public SizeFunction {
 public:
  // REQUIRES: `size` outlives this; the field is 0 or more and never undefined; base >= 0, growth >
  // 0 and parts > 0, all finite.
  FieldSize(const SizeFunction& size, std::unique_ptr<const Field> field, EdgesByField edges)
      : size_(&size), field_(std::move(field)), edges_(edges) {}

  void evaluate(std::size_t n, const double* x, const double* y,
                double* out) const noexcept override {
    size_->evaluate(n, x, y, out);
    alignas(64) std::array<double, kLanes> field;
    for (std::size_t i = 0; i < n; i += kLanes) {
      field_->evaluate(kLanes, x + i, y + i, field.data());
      for (std::size_t lane = 0; lane < kLanes; ++lane)
        out[i + lane] = least(out[i + lane], edge(field[lane]));
    }
  }
  Interval bounds(const Box& box) const noexcept override {
    const Interval size = size_->bounds(box);
    const Interval field = field_->bounds(box);
    return {least(size.lo, edge(field.lo)), least(size.hi, edge(field.hi)), size.may_be_nan};
  }
  double edge_steepness(const Box& box) const noexcept override {
    return std::max(size_->edge_steepness(box),
                    edges_.growth * field_->steepness(box) / edges_.parts);
  }
  double steepness(const Box& box) const noexcept override {
    const double longest = edge(field_->bounds(box).hi);
    return std::max(size_->steepness(box), 2 * area_of_edge(1) * longest * edges_.growth *
                                               field_->steepness(box) / edges_.parts);
  }
  Asked asked_at(Point p) const override { return size_->asked_at(p); }
  std::size_t bytes() const noexcept override { return field_->bytes(); }
  std::size_t operations() const noexcept override {
    return size_->operations() + field_->operations() + kOperations;
  }

 private:
  static constexpr std::size_t kOperations = 5;

  double edge(double field) const { return edges_.base + edges_.growth * (field / edges_.parts); }

  const SizeFunction* size_;
  std::unique_ptr<const Field> field_;
  EdgesByField edges_;
};

}  // namespace weft
