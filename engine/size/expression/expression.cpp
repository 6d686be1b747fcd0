// SPDX-License-Identifier: Apache-2.0
#include "engine/size/expression/expression.h"

#include <algorithm>
#include <string>
#include <utility>

#include "engine/size/expression/names.h"
#include "engine/size/expression/parser.h"
#include "engine/size/expression/program.h"
#include "engine/size/expression/program_bounds.h"
#include "engine/size/expression/source_position.h"
#include "engine/size/expression/threaded_code.h"

namespace weft {
namespace {

constexpr const char* kField = "size.expression";

struct Compiled {
  expr::Program code;
  std::vector<expr::FieldInput> fields;
  bool is_constant = false;
};

Result<Compiled> compiled(std::string_view source, std::span<const std::string> names) {
  if (source.size() > Expression::kMaxLength) {
    return fail(ErrorCode::kExpressionTooComplex, kField,
                "the size expression has " + std::to_string(source.size()) +
                    " bytes; the limit is " + std::to_string(Expression::kMaxLength));
  }
  Result<expr::Parsed> parsed = expr::parse(source, names, Expression::kMaxDepth);
  if (!parsed) return tl::unexpected(parsed.error());
  Result<expr::Program> code =
      expr::compile(parsed->graph, parsed->root, expr::kFirstFieldInput + parsed->fields.size(),
                    Expression::kMaxOperations, Expression::kMaxRegisters);
  if (!code) return tl::unexpected(std::move(code).error());
  const bool is_constant = parsed->graph[parsed->root].op == expr::Op::kConstant;
  return Compiled{*std::move(code), std::move(parsed->fields), is_constant};
}

bool is_name(std::string_view text) {
  const auto letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  const auto rest = [&](char c) { return letter(c) || (c >= '0' && c <= '9'); };
  return !text.empty() && text.size() <= Expression::kMaxNameLength && letter(text.front()) &&
         std::all_of(text.begin(), text.end(), rest);
}

}  // namespace

struct Expression::Program {
  expr::Program code;
  expr::ThreadedCode threaded;
  std::vector<const Field*> fields;                  // the inputs from kFirstFieldInput on
  std::vector<std::unique_ptr<const Field>> slopes;  // those of them that belong to no one else
  bool is_constant = false;
};

Result<Expression> Expression::parse(std::string_view source, std::span<const NamedField> fields) {
  std::vector<std::string> names;
  for (const NamedField& named : fields) names.push_back(named.name);
  Result<Compiled> made = compiled(source, names);
  if (!made) return tl::unexpected(std::move(made).error());
  expr::ThreadedCode threaded(made->code);
  std::unique_ptr<Program> program(
      new Program{std::move(made->code), std::move(threaded), {}, {}, made->is_constant});
  for (const expr::FieldInput& input : made->fields) {
    const NamedField& named = fields[input.field];
    if (!input.slope) {
      program->fields.push_back(named.field);
      continue;
    }
    program->slopes.push_back(named.field->slope());
    if (!program->slopes.back())
      return fail(ErrorCode::kBadOption, kField, "the field " + named.name + " has no slope");
    program->fields.push_back(program->slopes.back().get());
  }
  return Expression(std::move(program));
}

Result<std::vector<bool>> Expression::check(std::string_view source,
                                            std::span<const std::string> names) {
  const Result<Compiled> made = compiled(source, names);
  if (!made) return tl::unexpected(made.error());
  std::vector<bool> used(names.size());
  for (const expr::FieldInput& input : made->fields) used[input.field] = true;
  return used;
}

std::optional<Error> Expression::check_names(std::span<const std::string> names) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto bad = [&](const std::string& what) {
      const std::string field = "size.fields[" + std::to_string(i) + "].name";
      return Error{ErrorCode::kBadOption, field,
                   field + " is " + expr::quoted(names[i]) + "; " + what};
    };
    if (!is_name(names[i])) {
      return bad(
          "a name is made of letters, digits and _, begins with no digit, and has from 1 to " +
          std::to_string(kMaxNameLength) + " bytes");
    }
    if (expr::is_taken(names[i])) return bad("that name means something else in an expression");
    for (std::size_t j = 0; j < i; ++j) {
      if (names[j] == names[i])
        return bad("size.fields[" + std::to_string(j) + "] has the same name");
    }
  }
  return std::nullopt;
}

Expression::Expression(std::unique_ptr<const Program> program) : program_(std::move(program)) {}
Expression::Expression(Expression&&) noexcept = default;
Expression& Expression::operator=(Expression&&) noexcept = default;
Expression::~Expression() = default;

void Expression::evaluate(std::size_t n, const double* x, const double* y,
                          double* out) const noexcept {
  for (std::size_t i = 0; i < n; i += kLanes)
    program_->threaded.run(x + i, y + i, program_->fields, out + i);
}

Interval Expression::bounds(const Box& box) const noexcept {
  return expr::bounds(program_->code, box, program_->fields);
}

std::optional<double> Expression::constant() const noexcept {
  if (!program_->is_constant) return std::nullopt;
  return (*this)(Point{0, 0});
}

std::size_t Expression::operations() const noexcept {
  std::size_t sum = program_->threaded.operations();
  for (const Field* const field : program_->fields) sum += field->operations();
  return sum;
}

}  // namespace weft
