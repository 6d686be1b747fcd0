// SPDX-License-Identifier: Apache-2.0
// A number at every point of the plane, with bounds over boxes: what a size is, and what a size
// expression may name. NaN where the field is undefined.
//
// Determinism: a value depends on x and y alone, never on the batch, the machine or the compiler.
// Thread-safety: immutable.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>

#include "engine/base/geometry.h"
#include "engine/size/interval.h"

namespace weft {

class Field {
 public:
  static constexpr std::size_t kLanes = 8;  // points are evaluated this many at a time

  virtual ~Field() = default;

  // out[i] = value at (x[i], y[i]) for i < n. REQUIRES: all three arrays hold n rounded up to a
  // multiple of kLanes doubles (the excess is read and written), are aligned to 64 bytes and do not
  // overlap. No allocation; does not throw.
  virtual void evaluate(std::size_t n, const double* x, const double* y,
                        double* out) const noexcept = 0;

  double operator()(Point p) const noexcept;

  // Bounds over the box of what `evaluate` returns, bit for bit: rounding included. A box that is
  // empty or NaN gives anything.
  virtual Interval bounds(const Box& box) const noexcept = 0;

  // How much the value changes over the box, per unit of length: |f(p) - f(q)| <= s |p - q|, but
  // for rounding, for any p and q of the box whose segment has a value everywhere. Infinity if it
  // jumps, or if nothing is known.
  virtual double steepness(const Box& box) const noexcept {
    static_cast<void>(box);
    return std::numeric_limits<double>::infinity();
  }

  // The length of the gradient, as a field of its own, which refers to this one; null if the field
  // does not tell it.
  virtual std::unique_ptr<const Field> slope() const { return nullptr; }

  // Bytes of memory that grow with the request: what it holds, and what it was made from.
  virtual std::size_t bytes() const noexcept { return 0; }

  // What an evaluation costs, in operations of about 1 ns for kLanes points: for callers that pace
  // their polling by it.
  virtual std::size_t operations() const noexcept = 0;
};

}  // namespace weft
