// SPDX-License-Identifier: Apache-2.0
// Runs a program on intervals instead of numbers.
#pragma once

#include "engine/base/geometry.h"
#include "engine/size/expression/program.h"
#include "engine/size/interval.h"

namespace weft::expr {

// Bounds over the box of what the threaded code of the same program computes, bit for bit.
// REQUIRES: at most kMaxRegisters registers. No allocation.
Interval bounds(const Program& program, const Box& box) noexcept;

}  // namespace weft::expr
