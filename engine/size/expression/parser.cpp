// SPDX-License-Identifier: Apache-2.0
#include "engine/size/expression/parser.h"

#include <algorithm>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/size/expression/lexer.h"
#include "engine/size/expression/names.h"
#include "engine/size/expression/source_position.h"

namespace weft::expr {

namespace {

using Kind = Token::Kind;

enum Precedence { kLoosest = 1, kOr = 1, kAnd, kComparison, kSum, kProduct };

struct BinaryOperator {
  Precedence precedence;
  Op op;
  bool swapped = false;  // a > b is b < a
};

std::optional<BinaryOperator> binary_operator(const Token& token) {
  if (token.kind != Kind::kSymbol) return std::nullopt;
  const std::string_view s = token.text;
  if (s == "||") return BinaryOperator{kOr, Op::kOr};
  if (s == "&&") return BinaryOperator{kAnd, Op::kAnd};
  if (s == "<") return BinaryOperator{kComparison, Op::kLess};
  if (s == "<=") return BinaryOperator{kComparison, Op::kLessEqual};
  if (s == ">") return BinaryOperator{kComparison, Op::kLess, true};
  if (s == ">=") return BinaryOperator{kComparison, Op::kLessEqual, true};
  if (s == "==") return BinaryOperator{kComparison, Op::kEqual};
  if (s == "!=") return BinaryOperator{kComparison, Op::kNotEqual};
  if (s == "+") return BinaryOperator{kSum, Op::kAdd};
  if (s == "-") return BinaryOperator{kSum, Op::kSubtract};
  if (s == "*") return BinaryOperator{kProduct, Op::kMultiply};
  if (s == "/") return BinaryOperator{kProduct, Op::kDivide};
  return std::nullopt;
}

// The first error wins: `fail` keeps it and turns the rest of the source into its end, which every
// rule below leaves at once. So no rule needs to pass errors on.
class Parser {
 public:
  Parser(std::string_view source, std::span<const std::string> names, std::size_t max_depth)
      : source_(source), names_(names), max_depth_(max_depth), lexer_(source) {}

  Result<Parsed> run() {
    advance();
    if (token_.kind == Kind::kEnd) fail("the expression is empty");
    const NodeId root = graph_.number(conditional());
    if (token_.kind != Kind::kEnd) fail("expected an operator, found " + found());
    if (error_) return tl::unexpected(*std::move(error_));
    return Parsed{std::move(graph_), root, std::move(fields_)};
  }

 private:
  // condition ? a : condition ? b : c, a chain of any length.
  NodeId conditional() {
    std::vector<std::pair<NodeId, NodeId>> cases;
    NodeId value = binary(kLoosest);
    while (accept("?")) {
      const NodeId then = nested(&Parser::conditional);
      expect(":", "to go with '?'");
      cases.emplace_back(value, then);
      value = binary(kLoosest);
    }
    for (; !cases.empty(); cases.pop_back()) {
      value = graph_.select(cases.back().first, cases.back().second, value);
    }
    return value;
  }

  // Operators at least as tight as `loosest`.
  NodeId binary(int loosest) {
    NodeId left = unary();
    while (const auto op = binary_operator(token_)) {
      if (op->precedence < loosest) break;
      advance();
      const NodeId right = binary(op->precedence + 1);
      left = op->swapped ? graph_.binary(op->op, right, left) : graph_.binary(op->op, left, right);
      const auto next = binary_operator(token_);
      if (op->precedence == kComparison && next && next->precedence == kComparison) {
        fail("comparisons do not chain; write a < b && b < c, or use parentheses");
      }
    }
    return left;
  }

  NodeId unary() {
    if (accept("-")) return graph_.unary(Op::kNegate, nested(&Parser::unary));
    if (accept("+")) return graph_.number(nested(&Parser::unary));
    if (accept("!")) return graph_.unary(Op::kNot, nested(&Parser::unary));
    return power();
  }

  NodeId power() {
    const NodeId base = primary();
    return accept("^") ? graph_.power(base, nested(&Parser::unary)) : base;
  }

  NodeId primary() {
    const Token token = token_;
    if (token.kind == Kind::kNumber) {
      advance();
      return graph_.constant(token.value);
    }
    if (token.kind == Kind::kName) {
      advance();
      return named(token);
    }
    if (accept("(")) {
      const NodeId inner = nested(&Parser::conditional);
      close(token);
      return inner;
    }
    fail("expected a number, a name or '(', found " + found());
    return graph_.constant(0);
  }

  NodeId named(const Token& name) {
    if (const Function* function = find_function(name.text)) return call(name, *function);
    const std::optional<NodeId> value = this->value(name.text);
    if (!value) {
      fail(explain_unknown(name.text, names_), name);
      return graph_.constant(0);
    }
    if (is("(")) fail(quoted(name.text) + " is not a function; a product is written *");
    return *value;
  }

  std::optional<NodeId> value(std::string_view name) {
    if (name == "x") return graph_.input(kInputX);
    if (name == "y") return graph_.input(kInputY);
    if (name == "pi") return graph_.constant(std::numbers::pi);
    if (name == "e") return graph_.constant(std::numbers::e);
    if (const auto field = field_named(name)) return field_input({*field, false});
    return std::nullopt;
  }

  std::optional<std::size_t> field_named(std::string_view name) const {
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end()) return std::nullopt;
    return static_cast<std::size_t>(found - names_.begin());
  }

  NodeId field_input(const FieldInput& input) {
    const auto found = std::find(fields_.begin(), fields_.end(), input);
    const auto number = static_cast<std::uint16_t>(found - fields_.begin());
    if (found == fields_.end()) fields_.push_back(input);
    return graph_.input(static_cast<std::uint16_t>(kFirstFieldInput + number));
  }

  // The one function that takes a field itself, instead of its value.
  NodeId slope(const Token& open) {
    const Token argument = token_;
    const auto field =
        argument.kind == Kind::kName ? field_named(argument.text) : std::optional<std::size_t>{};
    if (!field) {
      fail("slope takes the name of a field");
      return graph_.constant(0);
    }
    advance();
    close(open);
    return field_input({*field, true});
  }

  NodeId call(const Token& name, const Function& function) {
    const Token open = token_;
    if (!accept("(")) {
      fail("the function " + quoted(name.text) + " needs arguments in parentheses", name);
      return graph_.constant(0);
    }
    if (function.name == "slope") return slope(open);
    std::vector<NodeId> arguments;
    if (!is(")")) {
      do {
        arguments.push_back(graph_.number(nested(&Parser::conditional)));
      } while (accept(","));
    }
    close(open);
    if (arguments.size() < function.min_arguments ||
        arguments.size() > function.max_arguments.value_or(arguments.size())) {
      fail(wrong_count(function, arguments.size()), name);
      return graph_.constant(0);
    }
    return apply(function, arguments);
  }

  NodeId apply(const Function& function, const std::vector<NodeId>& arguments) {
    if (function.name == "pow") return graph_.power(arguments[0], arguments[1]);
    if (function.name == "clamp") {
      const NodeId raised = graph_.binary(Op::kMax, arguments[0], arguments[1]);
      return graph_.binary(Op::kMin, raised, arguments[2]);
    }
    if (arguments.size() == 1) return graph_.unary(*function.op, arguments[0]);
    NodeId value = arguments[0];
    for (std::size_t i = 1; i < arguments.size(); ++i) {
      value = graph_.binary(*function.op, value, arguments[i]);
    }
    return value;
  }

  static std::string wrong_count(const Function& function, std::size_t given) {
    std::string text = quoted(function.name) + " takes ";
    if (!function.max_arguments) text += "at least ";
    text += std::to_string(function.min_arguments);
    return text + (function.min_arguments == 1 ? " argument, " : " arguments, ") +
           std::to_string(given) + " given";
  }

  NodeId nested(NodeId (Parser::*rule)()) {
    if (depth_ == max_depth_) {
      fail("nested deeper than " + std::to_string(max_depth_) + " levels", token_,
           ErrorCode::kExpressionTooComplex);
      return graph_.constant(0);
    }
    ++depth_;
    const NodeId value = (this->*rule)();
    --depth_;
    return value;
  }

  bool is(std::string_view symbol) const {
    return token_.kind == Kind::kSymbol && token_.text == symbol;
  }

  bool accept(std::string_view symbol) {
    if (!is(symbol)) return false;
    advance();
    return true;
  }

  void expect(std::string_view symbol, const std::string& purpose) {
    if (!accept(symbol)) {
      fail("expected " + quoted(symbol) + " " + purpose + ", found " + found());
    }
  }

  void close(const Token& open) {
    expect(")", "to close the '(' at " + position(source_, open.offset));
  }

  void advance() {
    if (error_) return;
    token_ = lexer_.next();
    if (token_.kind == Kind::kBad) fail(token_.problem);
  }

  std::string found() const { return token_.kind == Kind::kEnd ? "the end" : quoted(token_.text); }

  void fail(const std::string& what) { fail(what, token_); }

  void fail(const std::string& what, const Token& at,
            ErrorCode code = ErrorCode::kExpressionSyntax) {
    if (!error_) error_ = Error{code, "size.expression", describe(source_, at.offset, what)};
    token_ = Token{};
  }

  std::string_view source_;
  std::span<const std::string> names_;
  std::size_t max_depth_;
  Lexer lexer_;
  Token token_;
  std::size_t depth_ = 0;
  Graph graph_;
  std::vector<FieldInput> fields_;
  std::optional<Error> error_;
};

}  // namespace

Result<Parsed> parse(std::string_view source, std::span<const std::string> names,
                     std::size_t max_depth) {
  return Parser(source, names, max_depth).run();
}

}  // namespace weft::expr
