// SPDX-License-Identifier: Apache-2.0
// The grading function as a caller gives it: the one place of the checker that knows its kinds.
//
//   auto size = size_function("0.01 + x^2");
//   if (!size) return size.error();
//   double bound = (*size)({1, 2});
#pragma once

#include <functional>
#include <string>
#include <tl/expected.hpp>
#include <variant>

#include "checker/domain.h"
#include "checker/size/raster.h"

namespace weft::check {

using SizeSpec = std::variant<std::monostate,  // no bound
                              std::string,     // of x and y (size_expression.h)
                              Raster>;         // values on a grid

// The upper bound on a triangle's area at its centroid, squared units; empty if there is none. NaN
// if it cannot be computed. Errors: a sentence that says what was not understood, and where.
// REQUIRES: `spec` outlives the function. Not thread-safe: one function per thread.
tl::expected<std::function<double(Vec2)>, std::string> size_function(const SizeSpec& spec);

}  // namespace weft::check
