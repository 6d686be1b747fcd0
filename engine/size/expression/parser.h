// SPDX-License-Identifier: Apache-2.0
// The grammar of size expressions (expression.h), by recursive descent into a graph.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/size/expression/graph.h"
#include "weft/error.h"

namespace weft::expr {

// What a point brings besides its coordinates: the value of a field there, or the field's slope.
struct FieldInput {
  std::size_t field = 0;  // its place among the names
  bool slope = false;
  friend bool operator==(const FieldInput&, const FieldInput&) = default;
};

// Numbers of inputs.
inline constexpr std::uint16_t kInputX = 0;
inline constexpr std::uint16_t kInputY = 1;
inline constexpr std::uint16_t kFirstFieldInput = 2;

struct Parsed {
  Graph graph;
  NodeId root = 0;                 // a number
  std::vector<FieldInput> fields;  // inputs from kFirstFieldInput on, each once
};

// Recursion is bounded by max_depth. `names` are those of the fields; one that means something else
// already is hidden by that. Errors: kExpressionSyntax, and kExpressionTooComplex for deeper
// nesting.
Result<Parsed> parse(std::string_view source, std::span<const std::string> names,
                     std::size_t max_depth);

}  // namespace weft::expr
