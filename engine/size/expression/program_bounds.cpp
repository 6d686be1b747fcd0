// SPDX-License-Identifier: Apache-2.0
#include "engine/size/expression/program_bounds.h"

#include <array>

#include "engine/size/expression/interval_arithmetic.h"
#include "engine/size/expression/parser.h"
#include "engine/size/expression/threaded_code.h"

namespace weft::expr {

namespace {

// Not initialised: to give all of them a value took most of the time of a short program.
union Register {
  Register() {}
  Interval value;
};

}  // namespace

Interval bounds(const Program& program, const Box& box,
                std::span<const Field* const> fields) noexcept {
  std::array<Register, kMaxRegisters> registers;
  registers[kInputX].value = coordinate_bounds(box.min_x, box.max_x);
  registers[kInputY].value = coordinate_bounds(box.min_y, box.max_y);
  for (std::size_t i = 0; i < fields.size(); ++i)
    registers[kFirstFieldInput + i].value = fields[i]->bounds(box);
  Interval accumulator;
  const auto read = [&](const Operand& operand) -> Interval {
    switch (operand.from) {
      case Operand::From::kAccumulator:
        return accumulator;
      case Operand::From::kRegister:
        return registers[operand.reg].value;
      default:
        return constant_bounds(operand.value);
    }
  };
  for (const Instruction& instruction : program) {
    const Operand* const operands = instruction.operands.data();
    switch (arity(instruction.op)) {
      case 1:
        accumulator = unary_bounds(instruction.op, instruction.exponent, read(operands[0]));
        break;
      case 2:
        accumulator = binary_bounds(instruction.op, read(operands[0]), read(operands[1]));
        break;
      default:
        accumulator = select_bounds(read(operands[0]), read(operands[1]), read(operands[2]));
    }
    if (instruction.store) registers[*instruction.store].value = accumulator;
  }
  return accumulator;
}

}  // namespace weft::expr
