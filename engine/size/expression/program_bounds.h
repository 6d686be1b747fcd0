// SPDX-License-Identifier: Apache-2.0
// Runs a program on intervals instead of numbers.
#pragma once

#include <span>

#include "engine/base/geometry.h"
#include "engine/size/expression/program.h"
#include "engine/size/field.h"
#include "engine/size/interval.h"

namespace weft::expr {

// Bounds over the box of what the threaded code of the same program computes, bit for bit.
// `fields` are the inputs from kFirstFieldInput on. REQUIRES: at most kMaxRegisters registers. No
// allocation.
Interval bounds(const Program& program, const Box& box,
                std::span<const Field* const> fields) noexcept;

}  // namespace weft::expr
