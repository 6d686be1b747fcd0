// SPDX-License-Identifier: Apache-2.0
// The functions that an expression may call, and help with unknown names.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "engine/size/expression/operation.h"

namespace weft::expr {

struct Function {
  std::string_view name;
  std::size_t min_arguments = 1;
  std::optional<std::size_t> max_arguments;  // nullopt: any number
  std::optional<Op> op;  // nullopt: clamp, pow and slope, which the parser expands
};

const Function* find_function(std::string_view name);

// Whether the name means something in every expression: a function, x, y, pi or e.
bool is_taken(std::string_view name);

// Returns a sentence that says that `name` is unknown, and suggests a name, one of `fields`
// perhaps.
std::string explain_unknown(std::string_view name, std::span<const std::string> fields);

}  // namespace weft::expr
