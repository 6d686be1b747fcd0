// SPDX-License-Identifier: Apache-2.0
// A program as threaded code, which `Expression::evaluate` runs.
//
// A step is a handler and its operands; a handler computes 8 lanes and jumps to the next step's
// handler. The accumulator is passed as an argument in four vector registers, so only results that
// are used again later are written to memory. Each
// handler is specialised at compile time for its operation and for the source of its operands,
// so it has no branch but the jump. J. R. Bell, "Threaded Code", CACM 16(6), 1973.
//
// For 8 lanes of `(x>=0 && abs(y)<5) || (x<0 && x^2+y^2<25) ? 1.2e-3 : 1e-2` (12 operations) on a
// Sapphire Rapids Xeon, ns per call, least of many:
//
//                                                        gcc 12   clang 14
//   handlers, accumulator as argument (this)               13        15
//   handlers, three-address code on a register file        25        32
//   switch, three-address code on a register file          28        25
//   ... with 4 and with 8 lanes per vector               25, 24    19, 25
//   this, with 4 and with 8 lanes per vector             19, 12    12, 17
//
// Wider vectors do not justify a choice by processor. Expression::evaluate adds 2 ns per call.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/simd.h"
#include "engine/size/expression/expression.h"
#include "engine/size/expression/program.h"

namespace weft::expr {

inline constexpr std::size_t kBlock = Expression::kLanes;
inline constexpr std::size_t kMaxRegisters = Expression::kMaxRegisters;  // 16 KiB of stack

struct Step;

// `frame` holds the registers, kBlock doubles each; `out` receives the last step's result; the
// other arguments are the accumulator. Returns when the program has ended.
using Handler = void (*)(const Step* step, double* frame, double* out, __m128d a0, __m128d a1,
                         __m128d a2, __m128d a3);

struct Step {
  Handler run = nullptr;
  std::uint16_t store = 0;  // these are offsets into the frame, in doubles
  std::uint16_t operands[3] = {};
  double constants[2] = {};  // of the last two operands of a select, else of the first two
};

class ThreadedCode {
 public:
  // REQUIRES: at most Expression::kMaxOperations instructions and kMaxRegisters registers.
  explicit ThreadedCode(const Program& program);

  // out[i] = value at (x[i], y[i]) for i < kBlock. `fields` are the inputs from kFirstFieldInput
  // on. REQUIRES: alignment to 16 bytes, to 64 if there are fields.
  void run(const double* x, const double* y, std::span<const Field* const> fields,
           double* out) const noexcept;

  std::size_t operations() const { return steps_.size() - 1; }

 private:
  std::vector<Step> steps_;
};

}  // namespace weft::expr
