// SPDX-License-Identifier: Apache-2.0
// The size as a request gives it, and the one place that knows its kinds. What reads a request,
// plans, refines or estimates sees a SizeFunction; a new kind is a type here, a file pair beside
// this one, and a case in size_spec.cpp.
//
//   Result<std::unique_ptr<const SizeFunction>> size = make_size("0.01 + x^2");
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <variant>

#include "engine/base/error.h"
#include "engine/size/expression/expression.h"
#include "engine/size/raster.h"
#include "engine/size/size_function.h"

namespace weft {

// The grading function: an upper bound on a triangle's area at its centroid, in squared units.
using SizeSpec = std::variant<std::monostate,  // no bound on the area
                              double,          // the same everywhere, > 0 (constant_size.h)
                              std::string,     // of x and y (expression/expression.h)
                              Raster>;         // values on a grid (raster.h)

// REQUIRES: a raster satisfies its own requirements (raster.h), and `spec` outlives the result.
// Errors: kBadSizeValue for a constant or a raster's value that is not positive and finite, and
// those of Expression::parse. The field is "size.constant", "size.expression" or
// "size.raster.values[i]".
Result<std::unique_ptr<const SizeFunction>> make_size(const SizeSpec& spec);

// Bytes of memory that make_size takes for `spec`, which itself is held already.
std::uint64_t bytes_to_make(const SizeSpec& spec);

}  // namespace weft
