// SPDX-License-Identifier: Apache-2.0
// Parses untrusted JSON. Errors (kUnreadableInput) carry file:line:column.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "files/base/error.h"

namespace weft::files {

// Refuses text nested deeper than `max_depth` before anything is built from it.
Result<nlohmann::json> parse_json(const std::string& name, std::string_view text, int max_depth);

}  // namespace weft::files
