// SPDX-License-Identifier: Apache-2.0
// The grading function as users write it: an expression in x, y and named fields, parsed once,
// compiled to a batch program.
//
// Grammar, loosest first; binary operators associate to the left, but ^ and ?: to the right:
//   condition ? a : b
//   ||                  &&
//   < <= > >= == !=     (do not chain: 0 < x < 5 is refused)
//   + -                 * /
//   unary - + !         ^        -x^2 is -(x^2), 2^-1 is 0.5
//   numbers (1, .5, 1e-3), x, y, pi, e, names of fields, ( )
//   sqrt abs exp log sin cos tan floor ceil (1 argument; log is natural, angles are in radians),
//   pow atan2 hypot (2), min max (2 or more), clamp(v, lo, hi) = min(max(v, lo), hi),
//   slope(f), the length of the gradient of the field f, defined(v), which is false if v is NaN,
//   coalesce(v, w, ...), the first that is not NaN
// Spaces, tabs and newlines are free.
//
// Truth values: comparisons, &&, || and ! give 1 or 0; as a condition 0 is false and all else is
// true, NaN included. Both sides of every operator are computed; the side of ?: that is not taken
// has no effect.
//
// NaN and infinities follow IEEE 754: 1/0 is infinite, sqrt(-1) is NaN, comparisons with NaN are
// false (!= is true). min, max and clamp of a NaN are NaN, so that an undefined size is detected.
//
// Determinism: a value depends only on x, y and the fields, never on the batch, the machine or the
// compiler: arithmetic is IEEE 754 without contraction, transcendental functions are SLEEF's
// width-independent (cinz) ones, within 3.5 units in the last place (1 for exp and pow). Powers
// with an integer constant exponent from -16 to 16 are products, a^0.5 is sqrt(a), e^a is exp(a);
// pow is the same as ^.
//
//   Result<Expression> size = Expression::parse("x^2 + y^2 < 25 ? 1e-3 : 1e-2");
//   double bound = (*size)({3, 4});                      // 1e-2
//   double least = size->bounds({0, 0, 3, 3}).lo;        // 1e-3
//
// A small compiler: lexer, parser, graph, program, and one evaluator each for values, bounds and
// steepness.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/geometry.h"
#include "engine/size/interval.h"
#include "engine/size/size_function.h"
#include "weft/error.h"
#include "weft/size.h"

namespace weft {

// A field that an expression may name.
struct NamedField {
  std::string name;
  const Field* field = nullptr;
};

class Expression final : public SizeFunction {
 public:
  // Nesting of parentheses, arguments, unary operators, exponents, and the operand between ? and :.
  // Sums, products and chains a ? b : c ? d : ... do not nest.
  static constexpr std::size_t kMaxDepth = 256;
  static constexpr std::size_t kMaxOperations = 4096;  // after folding; equal ones count once
  static constexpr std::size_t kMaxRegisters =
      256;  // values alive at once, x, y and fields included

  // Errors: kExpressionSyntax with "line, column" and a caret under the offender in the message,
  // kExpressionTooComplex with the limit, kBadOption for the slope of a field that has none; the
  // field is "size.expression". Any bytes are safe. REQUIRES: the fields outlive the expression.
  static Result<Expression> parse(std::string_view source, std::span<const NamedField> fields = {});

  // What is known of an expression without its fields.
  struct Judged {
    std::vector<bool> used;          // for each name, whether it is
    std::optional<double> constant;  // the value, if it is the same everywhere
  };

  // What parse would say of an expression that names these fields.
  static Result<Judged> check(std::string_view source, std::span<const std::string> names);

  // The arguments, if all of the source is min(a, b, ...); otherwise none. REQUIRES: it parses.
  static std::vector<std::string> arguments_of_min(std::string_view source);

  // Judges the names of fields: letters, digits and _, a letter or _ first, at most
  // kMaxFieldNameBytes, none twice, none that means something else already. The error (kBadOption)
  // names "size.fields[i].name".
  static std::optional<Error> check_names(std::span<const std::string> names);

  Expression(Expression&&) noexcept;
  Expression& operator=(Expression&&) noexcept;
  ~Expression() override;

  // Cost of 8 lanes: about 1 ns per operation, 3 per division or sqrt, 14 to 60 per transcendental
  // function, 220 per pow (lanes.h, threaded_code.h).
  void evaluate(std::size_t n, const double* x, const double* y,
                double* out) const noexcept override;

  // Without transcendental functions nothing is widened, so lo == hi if the expression is piecewise
  // constant and the box lies in one piece.
  Interval bounds(const Box& box) const noexcept override;

  // Infinite where a condition or a step is undecided, and at poles (program_steepness.h).
  double steepness(const Box& box) const noexcept override;

  // The value if neither x, y nor a field is left after folding.
  std::optional<double> constant() const noexcept override;

  std::unique_ptr<const SizeFunction> along(const Field& field) const override;
  Asked asked_at(Point p) const override;

  // At most kMaxOperations, and those of the fields.
  std::size_t operations() const noexcept override;

 private:
  struct Program;
  explicit Expression(std::unique_ptr<const Program> program);
  std::unique_ptr<const Program> program_;
};

}  // namespace weft
