// SPDX-License-Identifier: Apache-2.0
// The functions an expression may call, and help with names that do not exist.
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
  std::optional<std::size_t> max_arguments;  // none: any number
  std::optional<Op> op;                      // none for clamp and pow, which the parser spells out
};

const Function* find_function(std::string_view name);

// A sentence on why `name` means nothing here and what may have been meant.
std::string explain_unknown(std::string_view name);

}  // namespace weft::expr
