// SPDX-License-Identifier: Apache-2.0
#include "engine/size/expression/expression.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "engine/size/expression/lexer.h"
#include "engine/size/expression/names.h"
#include "engine/size/expression/parser.h"
#include "engine/size/expression/program.h"
#include "engine/size/expression/program_bounds.h"
#include "engine/size/expression/program_steepness.h"
#include "engine/size/expression/source_position.h"
#include "engine/size/expression/threaded_code.h"

namespace weft {
namespace {

constexpr const char* kField = "size.expression";

struct Compiled {
  expr::Program code;
  std::vector<expr::FieldInput> fields;
  std::optional<double> constant;
};

Result<Compiled> compiled(std::string_view source, std::span<const std::string> names) {
  if (source.size() > kMaxExpressionBytes) {
    return fail(ErrorCode::kExpressionTooComplex, kField,
                "the size expression has " + std::to_string(source.size()) +
                    " bytes; the limit is " + std::to_string(kMaxExpressionBytes));
  }
  Result<expr::Parsed> parsed = expr::parse(source, names, Expression::kMaxDepth);
  if (!parsed) return tl::unexpected(parsed.error());
  Result<expr::Program> code =
      expr::compile(parsed->graph, parsed->root, expr::kFirstFieldInput + parsed->fields.size(),
                    Expression::kMaxOperations, Expression::kMaxRegisters);
  if (!code) return tl::unexpected(std::move(code).error());
  const expr::Node& root = parsed->graph[parsed->root];
  std::optional<double> constant;
  if (root.op == expr::Op::kConstant) constant = root.value;
  return Compiled{*std::move(code), std::move(parsed->fields), constant};
}

bool is_name(std::string_view text) {
  const auto letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  const auto rest = [&](char c) { return letter(c) || (c >= '0' && c <= '9'); };
  return !text.empty() && text.size() <= kMaxFieldNameBytes && letter(text.front()) &&
         std::all_of(text.begin(), text.end(), rest);
}

// The coordinate x as a field.
class Abscissa final : public Field {
 public:
  void evaluate(std::size_t n, const double* x, const double*,
                double* out) const noexcept override {
    std::copy_n(x, (n + kLanes - 1) / kLanes * kLanes, out);
  }
  Interval bounds(const Box& box) const noexcept override { return {box.min_x, box.max_x}; }
  double steepness(const Box&) const noexcept override { return 1; }
  std::size_t operations() const noexcept override { return 1; }
};

bool reads_coordinates(const expr::Program& program) {
  const auto is_coordinate = [](const expr::Operand& operand) {
    return operand.from == expr::Operand::From::kRegister && operand.reg < expr::kFirstFieldInput;
  };
  return std::any_of(program.begin(), program.end(), [&](const expr::Instruction& instruction) {
    const auto first = instruction.operands.begin();
    return std::any_of(first, first + expr::arity(instruction.op), is_coordinate);
  });
}

}  // namespace

struct Expression::Program {
  expr::Program code;
  expr::ThreadedCode threaded;
  std::vector<const Field*> fields;  // the inputs of the program, from kFirstFieldInput on
  std::vector<std::string> names;    // of the fields
  std::vector<std::unique_ptr<const Field>> slopes;  // the fields that the expression itself owns
  std::optional<double> constant;
};

Result<Expression> Expression::parse(std::string_view source, std::span<const NamedField> fields) {
  std::vector<std::string> names;
  for (const NamedField& named : fields) names.push_back(named.name);
  Result<Compiled> made = compiled(source, names);
  if (!made) return tl::unexpected(std::move(made).error());
  expr::ThreadedCode threaded(made->code);
  std::unique_ptr<Program> program(
      new Program{std::move(made->code), std::move(threaded), {}, {}, {}, made->constant});
  for (const expr::FieldInput& input : made->fields) {
    const NamedField& named = fields[input.field];
    program->names.push_back(input.slope ? "slope(" + named.name + ")" : named.name);
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

Result<Expression::Judged> Expression::check(std::string_view source,
                                             std::span<const std::string> names) {
  const Result<Compiled> made = compiled(source, names);
  if (!made) return tl::unexpected(made.error());
  Judged judged{std::vector<bool>(names.size()), made->constant};
  for (const expr::FieldInput& input : made->fields) judged.used[input.field] = true;
  return judged;
}

std::vector<std::string> Expression::arguments_of_min(std::string_view source) {
  expr::Lexer lexer(source);
  if (lexer.next().text != "min" || lexer.next().text != "(") return {};
  std::vector<std::string> arguments;
  std::size_t depth = 1;
  std::size_t first = source.find('(') + 1;
  while (depth > 0) {
    const expr::Token token = lexer.next();
    if (token.text == "(") ++depth;
    if (token.text == ")") --depth;
    if (depth == 0 || (depth == 1 && token.text == ",")) {
      arguments.emplace_back(source.substr(first, token.offset - first));
      first = token.offset + 1;
    }
  }
  if (lexer.next().kind != expr::Token::Kind::kEnd) return {};
  return arguments;
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
          std::to_string(kMaxFieldNameBytes) + " bytes");
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

double Expression::steepness(const Box& box) const noexcept {
  return expr::steepness(program_->code, box, program_->fields);
}

std::optional<double> Expression::constant() const noexcept {
  return program_->constant;
}

std::unique_ptr<const SizeFunction> Expression::along(const Field& field) const {
  static const Abscissa kAbscissa;
  if (program_->fields.size() != 1 || program_->fields[0] != &field ||
      reads_coordinates(program_->code))
    return nullptr;
  std::unique_ptr<Program> along(new Program{program_->code,
                                             expr::ThreadedCode(program_->code),
                                             {&kAbscissa},
                                             program_->names,
                                             {},
                                             program_->constant});
  return std::unique_ptr<const SizeFunction>(new Expression(std::move(along)));
}

SizeFunction::Asked Expression::asked_at(Point p) const {
  Asked asked{(*this)(p)};
  for (std::size_t i = 0; i < program_->fields.size(); ++i)
    if (std::isnan((*program_->fields[i])(p))) asked.undefined.push_back(program_->names[i]);
  return asked;
}

std::size_t Expression::operations() const noexcept {
  std::size_t sum = program_->threaded.operations();
  for (const Field* const field : program_->fields) sum += field->operations();
  return sum;
}

}  // namespace weft
