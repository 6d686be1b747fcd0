// SPDX-License-Identifier: Apache-2.0
// Runs a program on bounds of values and of their derivatives: forward differentiation.
#pragma once

#include <span>

#include "engine/base/geometry.h"
#include "engine/size/expression/program.h"
#include "engine/size/field.h"

namespace weft::expr {

// Field::steepness of what the program computes. `fields` are the inputs from kFirstFieldInput on.
// REQUIRES: at most kMaxRegisters registers. No allocation.
double steepness(const Program& program, const Box& box,
                 std::span<const Field* const> fields) noexcept;

}  // namespace weft::expr
