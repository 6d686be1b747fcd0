// SPDX-License-Identifier: Apache-2.0
// The functions that an expression may call, and help with unknown names.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "engine/size/expression/operation.h"

namespace weft::expr {

struct Function {
  std::string_view name;
  std::size_t min_arguments = 1;
  std::optional<std::size_t> max_arguments;  // nullopt: any number
  std::optional<Op> op;                      // nullopt: clamp and pow, which the parser expands
};

const Function* find_function(std::string_view name);

// Returns a sentence that says that `name` is unknown, and suggests a name.
std::string explain_unknown(std::string_view name);

}  // namespace weft::expr
