// SPDX-License-Identifier: Apache-2.0
// Prints JSON: an object on one line, in ASCII, with U+FFFD for bytes that are not UTF-8.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace weft::client {

using Json = nlohmann::ordered_json;

inline std::string json_line(const Json& json) {
  return json.dump(-1, ' ', true, Json::error_handler_t::replace) + "\n";
}

}  // namespace weft::client
