// SPDX-License-Identifier: Apache-2.0
// A size expression as straight-line code for a machine with one accumulator and a register file.
//
// Every instruction leaves its result in the accumulator; `store` says where else it is kept, if a
// later instruction than the next one uses it. An operand is the accumulator, a register or
// a constant. The first registers hold the inputs. The order of evaluation is that of R. Sethi and
// J. D. Ullman, "The Generation of Optimal Code for Arithmetic Expressions" (1970): the subtree
// that needs more registers first, so that a long chain needs few.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/size/expression/graph.h"
#include "engine/size/expression/operation.h"
#include "weft/error.h"

namespace weft::expr {

struct Operand {
  enum class From : std::uint8_t { kAccumulator, kRegister, kConstant };
  From from = From::kConstant;
  std::uint16_t reg = 0;
  double value = 0;
};

struct Instruction {
  Op op = Op::kCopy;
  int exponent = 0;                   // of kPowN
  std::array<Operand, 3> operands{};  // the first arity(op) count; never all constants
  std::optional<std::uint16_t> store = std::nullopt;
};

// The last instruction's result is the value.
using Program = std::vector<Instruction>;

// Errors: kExpressionTooComplex for more operations than max_operations or more values alive at
// once than max_registers, the inputs included: these are numbered from 0 to inputs - 1.
Result<Program> compile(const Graph& graph, NodeId root, std::size_t inputs,
                        std::size_t max_operations, std::size_t max_registers);

}  // namespace weft::expr
