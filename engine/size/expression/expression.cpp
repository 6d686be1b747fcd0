// SPDX-License-Identifier: Apache-2.0
#include "engine/size/expression/expression.h"

#include <string>
#include <utility>

#include "engine/size/expression/parser.h"
#include "engine/size/expression/program.h"
#include "engine/size/expression/program_bounds.h"
#include "engine/size/expression/threaded_code.h"

namespace weft {

struct Expression::Program {
  expr::Program code;
  expr::ThreadedCode threaded;
  bool is_constant = false;
};

Result<Expression> Expression::parse(std::string_view source) {
  if (source.size() > kMaxLength) {
    return fail(ErrorCode::kExpressionTooComplex, "size.expression",
                "the size expression has " + std::to_string(source.size()) +
                    " bytes; the limit is " + std::to_string(kMaxLength));
  }
  const Result<expr::Parsed> parsed = expr::parse(source, kMaxDepth);
  if (!parsed) return tl::unexpected(parsed.error());
  Result<expr::Program> code =
      expr::compile(parsed->graph, parsed->root, kMaxOperations, kMaxRegisters);
  if (!code) return tl::unexpected(std::move(code).error());
  expr::ThreadedCode threaded(*code);
  const bool is_constant = parsed->graph[parsed->root].op == expr::Op::kConstant;
  return Expression(std::unique_ptr<const Program>(
      new Program{*std::move(code), std::move(threaded), is_constant}));
}

Expression::Expression(std::unique_ptr<const Program> program) : program_(std::move(program)) {}
Expression::Expression(Expression&&) noexcept = default;
Expression& Expression::operator=(Expression&&) noexcept = default;
Expression::~Expression() = default;

void Expression::evaluate(std::size_t n, const double* x, const double* y,
                          double* out) const noexcept {
  for (std::size_t i = 0; i < n; i += kLanes) program_->threaded.run(x + i, y + i, out + i);
}

Interval Expression::bounds(const Box& box) const noexcept {
  return expr::bounds(program_->code, box);
}

std::optional<double> Expression::constant() const noexcept {
  if (!program_->is_constant) return std::nullopt;
  return (*this)(Point{0, 0});
}

std::size_t Expression::operations() const noexcept {
  return program_->threaded.operations();
}

}  // namespace weft
