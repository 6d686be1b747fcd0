// SPDX-License-Identifier: Apache-2.0
// The grammar of size expressions (expression.h), by recursive descent into a graph.
#pragma once

#include <cstddef>
#include <string_view>

#include "engine/base/error.h"
#include "engine/size/expression/graph.h"

namespace weft::expr {

struct Parsed {
  Graph graph;
  NodeId root = 0;  // a number
};

// Recursion is bounded by max_depth. Errors: kExpressionSyntax, and kExpressionTooComplex for
// deeper nesting.
Result<Parsed> parse(std::string_view source, std::size_t max_depth);

}  // namespace weft::expr
