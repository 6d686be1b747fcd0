// SPDX-License-Identifier: Apache-2.0
// A size whose gradation is measured within the domain, from
//   - `crow`, the size limited as the crow flies, across land: nowhere above the limit within, and
//     near to it wherever no land lies between;
//   - `size` without a limit, and `within`, a length of edges on a mesh of the domain that grows
//     by at most the gradation along any path in it (mesh_limit.h): the lesser is nowhere above the
//     limit within, and near to it behind land.
// So the larger of the two. Where `crow` is negative or NaN, it stays so. Thread-safety: immutable.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "engine/size/fields/mesh_field.h"
#include "engine/size/size_function.h"

namespace weft {

class WithinSize final : public SizeFunction {
 public:
  // REQUIRES: `crow` and `size` outlive this; `crow` is nowhere above `size`.
  WithinSize(const SizeFunction& crow, const SizeFunction& size, MeshField within)
      : crow_(&crow), size_(&size), within_(std::move(within)) {}

  void evaluate(std::size_t n, const double* x, const double* y,
                double* out) const noexcept override {
    crow_->evaluate(n, x, y, out);
    alignas(64) std::array<double, kLanes> size;
    alignas(64) std::array<double, kLanes> edge;
    for (std::size_t i = 0; i < n; i += kLanes) {
      size_->evaluate(kLanes, x + i, y + i, size.data());
      bool limited = false;
      for (std::size_t lane = 0; lane < kLanes; ++lane)
        limited = limited || out[i + lane] < size[lane];
      if (!limited) continue;
      within_.evaluate(kLanes, x + i, y + i, edge.data());
      for (std::size_t lane = 0; lane < kLanes; ++lane)
        out[i + lane] = larger(out[i + lane], std::min(size[lane], area_of_edge(edge[lane])));
    }
  }
  Interval bounds(const Box& box) const noexcept override {
    const Interval crow = crow_->bounds(box);
    const Interval size = size_->bounds(box);
    const Interval edge = within_.bounds(box);
    return {larger(crow.lo, std::min(size.lo, area_of_edge(edge.lo))),
            larger(crow.hi, std::min(size.hi, area_of_edge(edge.hi))), crow.may_be_nan};
  }
  Asked asked_at(Point p) const override { return crow_->asked_at(p); }
  std::size_t bytes() const noexcept override { return within_.bytes(); }
  std::size_t operations() const noexcept override {
    return crow_->operations() + size_->operations() + within_.operations();
  }

 private:
  // NaN if `crow` is.
  static double larger(double crow, double within) { return within > crow ? within : crow; }

  const SizeFunction* crow_;
  const SizeFunction* size_;
  MeshField within_;
};

}  // namespace weft
