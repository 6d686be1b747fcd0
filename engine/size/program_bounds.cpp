// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/size/program_bounds.h"

#include <array>

#include "engine/size/interval_arithmetic.h"
#include "engine/size/threaded_code.h"

namespace weft::expr {

Interval bounds(const Program& program, const Box& box) noexcept {
  std::array<Interval, kMaxRegisters> registers;
  registers[kRegisterX] = coordinate_bounds(box.min_x, box.max_x);
  registers[kRegisterY] = coordinate_bounds(box.min_y, box.max_y);
  Interval accumulator;
  const auto read = [&](const Operand& operand) -> Interval {
    switch (operand.from) {
      case Operand::From::kAccumulator:
        return accumulator;
      case Operand::From::kRegister:
        return registers[operand.reg];
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
    if (instruction.store) registers[*instruction.store] = accumulator;
  }
  return accumulator;
}

}  // namespace weft::expr
