// SPDX-License-Identifier: Apache-2.0
// The grading function, evaluated by muParser: independent of the engine's evaluator.
//
// The grammar is the service's: cond ? a : b, ||, &&, comparisons, + -, * /, unary - + !, ^ (to the
// right), from loose to tight, so that -x^2 is -(x^2) and 2^-1 is 0.5; numbers, x, y, pi, e, names
// of fields; sqrt abs exp log (natural) sin cos tan floor ceil, pow atan2 hypot, min max (two or
// more), clamp(v, lo, hi); slope(f) of a field, defined(v), which is 0 if v is NaN, and coalesce(v,
// w, ...), the first that is not NaN. min, max and clamp of a NaN are NaN. Other features of
// muParser (assignment, strings, lists, its own names) are refused.
//
//   auto size = SizeExpression::parse("0.01 + x^2");
//   if (!size) return size.error();
//   double bound = (*size)({1, 2});
//
// muParser's own limit holds: expressions below 20000 bytes. Values agree with the engine's to
// rounding. Not thread-safe: one object per thread. Does not throw.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "checker/domain.h"
#include "checker/size/field.h"

namespace weft::check {

// Returns what is wrong with the names: letters, digits and _, no digit first, at most 64 bytes;
// none twice, none that means something else. nullopt if nothing is.
std::optional<std::string> fault_of_names(std::span<const Field> fields);

class SizeExpression {
 public:
  static constexpr std::size_t kMaxLength = 19999;

  // Errors: a sentence that says what is wrong, and where. REQUIRES: the names have no fault.
  static tl::expected<SizeExpression, std::string> parse(std::string_view source,
                                                         std::span<const Field> fields = {});

  SizeExpression(SizeExpression&&) noexcept;
  SizeExpression& operator=(SizeExpression&&) noexcept;
  ~SizeExpression();

  // NaN if muParser refuses to evaluate.
  double operator()(Vec2 p) const noexcept;

 private:
  struct Evaluator;
  explicit SizeExpression(std::unique_ptr<Evaluator> evaluator);
  std::unique_ptr<Evaluator> evaluator_;
};

}  // namespace weft::check
