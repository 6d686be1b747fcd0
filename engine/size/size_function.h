// SPDX-License-Identifier: Apache-2.0
// A grading function: the upper bound on a triangle's area, in squared units, as a function of its
// centroid. Its values come with bounds over boxes, which guide the refinement (size_map.h).
//
// Determinism: a value depends on x and y alone, never on the batch, the machine or the compiler.
// Thread-safety: immutable.
#pragma once

#include <cstddef>
#include <optional>

#include "engine/base/geometry.h"
#include "engine/size/expression/interval.h"

namespace weft {

class SizeFunction {
 public:
  static constexpr std::size_t kLanes = 8;  // points are evaluated this many at a time

  virtual ~SizeFunction() = default;

  // out[i] = value at (x[i], y[i]) for i < n. REQUIRES: all three arrays hold n rounded up to a
  // multiple of kLanes doubles (the excess is read and written), are aligned to 64 bytes and do not
  // overlap. No allocation; does not throw.
  virtual void evaluate(std::size_t n, const double* x, const double* y,
                        double* out) const noexcept = 0;

  double operator()(Point p) const noexcept;

  // Bounds over the box of what `evaluate` returns, bit for bit: rounding included. A box that is
  // empty or NaN gives anything.
  virtual Interval bounds(const Box& box) const noexcept = 0;

  // The value, if it is known to be the same everywhere; infinity for no bound.
  virtual std::optional<double> constant() const noexcept { return std::nullopt; }

  // Bytes of memory that grow with the request: what it holds, and what it was made from.
  virtual std::size_t bytes() const noexcept { return 0; }

  // What an evaluation costs, in operations of about 1 ns for kLanes points: for callers that pace
  // their polling by it.
  virtual std::size_t operations() const noexcept = 0;
};

}  // namespace weft
