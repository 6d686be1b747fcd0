// SPDX-License-Identifier: Apache-2.0
// A size limited so that the length of edges h = sqrt(4/sqrt(3) * size) grows by at most G per unit
// of length:
//   h_G(p) = min over q in the domain of h(q) + G |p - q|,
// distances as the crow flies, across land, too. At points of the domain never above h_G, but for
// rounding, and at most 4 % below it (source_tree.h has the exceptions). Where the size is negative
// or NaN, it stays so, and such places limit nothing.
//
//   Result<GradedSize> graded = GradedSize::make(size, 0.15, domain, context);
//
// Deterministic at any number of threads. Thread-safety: immutable.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/context.h"
#include "engine/domain/domain.h"
#include "engine/size/gradation/limit_tree.h"
#include "engine/size/size_function.h"
#include "weft/error.h"

namespace weft {

class GradedSize final : public SizeFunction {
 public:
  // REQUIRES: `size` outlives the result; gradation > 0 and finite. Errors: those of the context.
  static Result<GradedSize> make(const SizeFunction& size, double gradation, const Domain& domain,
                                 const ExecutionContext& context) {
    auto sources = SourceTree::build(size, gradation, domain, context);
    if (!sources) return tl::unexpected(std::move(sources).error());
    auto limit = LimitTree::build(std::move(*sources), size, gradation, domain, context);
    if (!limit) return tl::unexpected(std::move(limit).error());
    return GradedSize(size, std::move(*limit));
  }

  // Whether the size itself keeps to the gradation: then this adds nothing to it.
  bool is_limited_already() const { return limit_.empty(); }
  const LimitTree& limit() const { return limit_; }

  void evaluate(std::size_t n, const double* x, const double* y,
                double* out) const noexcept override {
    size_->evaluate(n, x, y, out);
    if (limit_.empty()) return;
    alignas(64) std::array<double, kLanes> edge;
    for (std::size_t i = 0; i < n; i += kLanes) {
      limit_.evaluate(x + i, y + i, edge.data());
      for (std::size_t lane = 0; lane < kLanes; ++lane)
        out[i + lane] = least(out[i + lane], edge[lane]);
    }
  }
  Interval bounds(const Box& box) const noexcept override {
    const Interval size = size_->bounds(box);
    if (limit_.empty()) return size;
    const Interval edge = limit_.bounds(box);
    return {least(size.lo, edge.lo), least(size.hi, edge.hi), size.may_be_nan};
  }
  // With a limit, infinite: it jumps by up to its tolerance where lists of sources meet.
  double steepness(const Box& box) const noexcept override {
    return limit_.empty() ? size_->steepness(box) : std::numeric_limits<double>::infinity();
  }
  double edge_steepness(const Box& box) const noexcept override {
    return limit_.empty() ? size_->edge_steepness(box) : std::numeric_limits<double>::infinity();
  }
  std::optional<double> constant() const noexcept override { return size_->constant(); }
  Asked asked_at(Point p) const override { return size_->asked_at(p); }
  std::size_t bytes() const noexcept override { return limit_.bytes(); }
  std::size_t operations() const noexcept override {
    return size_->operations() + (limit_.empty() ? 0 : kOperations);
  }

 private:
  static constexpr std::size_t kOperations = 400;

  GradedSize(const SizeFunction& size, LimitTree limit) : size_(&size), limit_(std::move(limit)) {}

  const SizeFunction* size_;
  LimitTree limit_;
};

}  // namespace weft
