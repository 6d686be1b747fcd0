// SPDX-License-Identifier: Apache-2.0
#include "engine/size/expression/threaded_code.h"

#include <cassert>
#include <type_traits>

#include "engine/size/expression/lanes.h"
#include "engine/size/expression/parser.h"

// Both compilers turn the call of the next handler into a jump if they optimise; clang can be made
// to promise it. Without the jump, the stack grows by one small frame per operation, which
// kMaxOperations bounds.
#if defined(__clang__)
#define WEFT_TAIL_CALL [[clang::musttail]] return
#else
#define WEFT_TAIL_CALL return
#endif

namespace weft::expr {

namespace {

using From = Operand::From;

constexpr std::size_t kVectors = kBlock / 2;

// An operand's four vectors, wherever they are.
template <From F>
class Source {
 public:
  Source(const Lanes* accumulator, const double* frame, std::uint16_t offset, double constant)
      : accumulator_(accumulator), in_frame_(frame + offset), constant_(_mm_set1_pd(constant)) {}

  Lanes operator[](std::size_t i) const {
    if constexpr (F == From::kAccumulator) {
      return accumulator_[i];
    } else if constexpr (F == From::kRegister) {
      return _mm_load_pd(in_frame_ + 2 * i);
    } else {
      return constant_;
    }
  }

 private:
  [[maybe_unused]] const Lanes* accumulator_;
  [[maybe_unused]] const double* in_frame_;
  [[maybe_unused]] Lanes constant_;
};

template <bool kStore, class Compute>
inline void compute_block(const Step* step, double* frame, Lanes* accumulator, Compute compute) {
  double* const kept = frame + step->store;
  for (std::size_t i = 0; i < kVectors; ++i) {
    accumulator[i] = compute(i);
    if constexpr (kStore) _mm_store_pd(kept + 2 * i, accumulator[i]);
  }
}

template <class Operation, From A, bool kStore>
void unary(const Step* step, double* frame, double* out, Lanes a0, Lanes a1, Lanes a2, Lanes a3) {
  Lanes acc[kVectors] = {a0, a1, a2, a3};
  const Source<A> a(acc, frame, step->operands[0], step->constants[0]);
  compute_block<kStore>(step, frame, acc, [&](std::size_t i) { return Operation::of(a[i]); });
  WEFT_TAIL_CALL step[1].run(step + 1, frame, out, acc[0], acc[1], acc[2], acc[3]);
}

template <class Operation, From A, From B, bool kStore>
void binary(const Step* step, double* frame, double* out, Lanes a0, Lanes a1, Lanes a2, Lanes a3) {
  Lanes acc[kVectors] = {a0, a1, a2, a3};
  const Source<A> a(acc, frame, step->operands[0], step->constants[0]);
  const Source<B> b(acc, frame, step->operands[1], step->constants[1]);
  compute_block<kStore>(step, frame, acc, [&](std::size_t i) { return Operation::of(a[i], b[i]); });
  WEFT_TAIL_CALL step[1].run(step + 1, frame, out, acc[0], acc[1], acc[2], acc[3]);
}

template <From Mask, From A, From B, bool kStore>
void select(const Step* step, double* frame, double* out, Lanes a0, Lanes a1, Lanes a2, Lanes a3) {
  Lanes acc[kVectors] = {a0, a1, a2, a3};
  const Source<Mask> mask(acc, frame, step->operands[0], 0);
  const Source<A> a(acc, frame, step->operands[1], step->constants[0]);
  const Source<B> b(acc, frame, step->operands[2], step->constants[1]);
  compute_block<kStore>(step, frame, acc,
                        [&](std::size_t i) { return Select::of(mask[i], a[i], b[i]); });
  WEFT_TAIL_CALL step[1].run(step + 1, frame, out, acc[0], acc[1], acc[2], acc[3]);
}

void finish(const Step*, double*, double* out, Lanes a0, Lanes a1, Lanes a2, Lanes a3) {
  _mm_store_pd(out, a0);
  _mm_store_pd(out + 2, a1);
  _mm_store_pd(out + 4, a2);
  _mm_store_pd(out + 6, a3);
}

// Calls choose(std::integral_constant<From, from>{}).
template <class Choose>
Handler with_source(From from, Choose&& choose) {
  switch (from) {
    case From::kAccumulator:
      return choose(std::integral_constant<From, From::kAccumulator>{});
    case From::kRegister:
      return choose(std::integral_constant<From, From::kRegister>{});
    default:
      return choose(std::integral_constant<From, From::kConstant>{});
  }
}

Handler unary_handler(const Instruction& instruction) {
  const From from = instruction.operands[0].from;
  const bool store = instruction.store.has_value();
  if (instruction.op == Op::kCopy) {
    return from == From::kConstant ? &unary<Copy, From::kConstant, false>
                                   : &unary<Copy, From::kRegister, false>;
  }
  return visit_unary(instruction.op, instruction.exponent, [&](auto operation) -> Handler {
    using Operation = decltype(operation);
    assert(from != From::kConstant);
    if (from == From::kAccumulator) {
      return store ? &unary<Operation, From::kAccumulator, true>
                   : &unary<Operation, From::kAccumulator, false>;
    }
    return store ? &unary<Operation, From::kRegister, true>
                 : &unary<Operation, From::kRegister, false>;
  });
}

Handler binary_handler(const Instruction& instruction) {
  const bool store = instruction.store.has_value();
  return visit_binary(instruction.op, [&](auto operation) {
    using Operation = decltype(operation);
    return with_source(instruction.operands[0].from, [&](auto a) {
      return with_source(instruction.operands[1].from, [&](auto b) -> Handler {
        return store ? &binary<Operation, a(), b(), true> : &binary<Operation, a(), b(), false>;
      });
    });
  });
}

Handler select_handler(const Instruction& instruction) {
  const bool store = instruction.store.has_value();
  return with_source(instruction.operands[0].from, [&](auto mask) {
    return with_source(instruction.operands[1].from, [&](auto a) {
      return with_source(instruction.operands[2].from, [&](auto b) -> Handler {
        return store ? &select<mask(), a(), b(), true> : &select<mask(), a(), b(), false>;
      });
    });
  });
}

Step link(const Instruction& instruction) {
  Step step;
  const int count = arity(instruction.op);
  step.run = count == 1   ? unary_handler(instruction)
             : count == 2 ? binary_handler(instruction)
                          : select_handler(instruction);
  if (instruction.store) step.store = static_cast<std::uint16_t>(*instruction.store * kBlock);
  const int first_with_constant = count == 3 ? 1 : 0;
  for (int i = 0; i < count; ++i) {
    const Operand& operand = instruction.operands[i];
    step.operands[i] = static_cast<std::uint16_t>(operand.reg * kBlock);
    if (i >= first_with_constant) step.constants[i - first_with_constant] = operand.value;
  }
  return step;
}

}  // namespace

ThreadedCode::ThreadedCode(const Program& program) {
  assert(program.size() <= Expression::kMaxOperations);
  steps_.reserve(program.size() + 1);
  for (const Instruction& instruction : program) steps_.push_back(link(instruction));
  steps_.push_back(Step{.run = &finish});
}

void ThreadedCode::run(const double* x, const double* y, std::span<const Field* const> fields,
                       double* out) const noexcept {
  alignas(64) double frame[kMaxRegisters * kBlock];
  for (std::size_t i = 0; i < kBlock; i += 2) {
    _mm_store_pd(frame + kInputX * kBlock + i, _mm_load_pd(x + i));
    _mm_store_pd(frame + kInputY * kBlock + i, _mm_load_pd(y + i));
  }
  for (std::size_t i = 0; i < fields.size(); ++i)
    fields[i]->evaluate(kBlock, x, y, frame + (kFirstFieldInput + i) * kBlock);
  const Lanes none = _mm_setzero_pd();
  steps_[0].run(steps_.data(), frame, out, none, none, none, none);
}

}  // namespace weft::expr
