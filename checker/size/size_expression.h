// SPDX-License-Identifier: Apache-2.0
// The grading function, evaluated by operator precedence on a stack: independent of the engine's
// compiler.
//
// The grammar is the service's: cond ? a : b, ||, &&, comparisons, + -, * /, unary - + !, ^ (to the
// right), from loose to tight, so that -x^2 is -(x^2) and 2^-1 is 0.5; numbers, x, y, pi, e, names
// of fields; sqrt abs exp log (natural) sin cos tan floor ceil, pow atan2 hypot, min max (two or
// more), clamp(v, lo, hi); slope(f) of a field, defined(v), which is 0 if v is NaN, and coalesce(v,
// w, ...), the first that is not NaN. min, max and clamp of a NaN are NaN. Comparisons do not
// chain.
//
//   auto size = SizeExpression::parse("0.01 + x^2");
//   if (!size) return size.error();
//   double bound = (*size)({1, 2});
//
// Values agree with the engine's to rounding. Not thread-safe: one object per thread. Does not
// throw.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "checker/domain.h"
#include "checker/size/field.h"

namespace weft::check {

// Returns what is wrong with the names: letters, digits and _, no digit first, at most 64 bytes;
// none twice, none that means something else. nullopt if nothing is.
std::optional<std::string> fault_of_names(std::span<const Field> fields);

class SizeExpression {
 public:
  static constexpr std::size_t kMaxDepth = 1000;  // of parentheses, operands and exponents

  // Errors: a sentence that says what is wrong, and where. REQUIRES: the names have no fault.
  static tl::expected<SizeExpression, std::string> parse(std::string_view source,
                                                         std::span<const Field> fields = {});

  double operator()(Vec2 p) const noexcept;

 private:
  friend class ExpressionReader;

  // Replaces the last `operands` values of the stack by one of them.
  struct Step {
    using Operation = double (*)(const double* values, std::size_t count);
    Operation function = nullptr;
    std::size_t operands = 0;
    double number = 0;                   // pushed if there is no function and no input
    std::optional<std::size_t> input{};  // pushed: x, y, then those of fields
  };

  SizeExpression() = default;

  std::vector<Step> steps_;
  std::vector<std::function<double(Vec2)>> inputs_;
  mutable std::vector<double> stack_;
};

}  // namespace weft::check
