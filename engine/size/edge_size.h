// SPDX-License-Identifier: Apache-2.0
// A size that is given as the length of edges h: it bounds areas by that of an equilateral triangle
// of side h.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/size/size_function.h"

namespace weft {

class EdgeSize final : public SizeFunction {
 public:
  // REQUIRES: `edge` outlives this.
  explicit EdgeSize(const SizeFunction& edge) : edge_(&edge) {}
  explicit EdgeSize(std::unique_ptr<const SizeFunction> edge)
      : owned_(std::move(edge)), edge_(owned_.get()) {}

  void evaluate(std::size_t n, const double* x, const double* y,
                double* out) const noexcept override {
    edge_->evaluate(n, x, y, out);
    const std::size_t lanes = (n + kLanes - 1) / kLanes * kLanes;
    for (std::size_t i = 0; i < lanes; ++i) out[i] = area_of_edge(out[i]);
  }
  Interval bounds(const Box& box) const noexcept override {
    const Interval edge = edge_->bounds(box);
    return {area_of_edge(edge.lo), area_of_edge(edge.hi), edge.may_be_nan};
  }
  double edge_steepness(const Box& box) const noexcept override { return edge_->steepness(box); }
  double steepness(const Box& box) const noexcept override {
    const Interval edge = edge_->bounds(box);
    const double longest = std::max(std::fabs(edge.lo), std::fabs(edge.hi));
    const double steepness = edge_->steepness(box);
    return steepness == 0 ? 0 : 2 * area_of_edge(1) * longest * steepness * (1 + 0x1p-50);
  }
  std::optional<double> constant() const noexcept override {
    const auto edge = edge_->constant();
    return edge ? std::optional(area_of_edge(*edge)) : std::nullopt;
  }
  std::unique_ptr<const SizeFunction> along(const Field& field) const override {
    auto edge = edge_->along(field);
    return edge ? std::make_unique<EdgeSize>(std::move(edge)) : nullptr;
  }
  Asked asked_at(Point p) const override {
    Asked asked = edge_->asked_at(p);
    asked.is_edge = true;
    return asked;
  }
  std::size_t operations() const noexcept override { return edge_->operations() + 3; }

 private:
  std::unique_ptr<const SizeFunction> owned_;  // or null
  const SizeFunction* edge_;
};

}  // namespace weft
