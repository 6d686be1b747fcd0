// SPDX-License-Identifier: Apache-2.0
// The target of a request: its path, and the parameters of its query.
//
//   parse_target("/v1/mesh?edge=0.1+0.2*x&lonlat")->query    // {{"edge", "0.1+0.2*x"}, {"lonlat",
//   ""}}
//
// A plus is a plus, not a space as in forms: expressions have them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace weft::server {

struct Target {
  std::string path;
  std::vector<std::pair<std::string, std::string>> query;  // in its order, decoded
};

// nullopt: a percent sign is not followed by two hexadecimal digits, or what is decoded is not
// UTF-8 without control characters.
std::optional<Target> parse_target(std::string_view text);

}  // namespace weft::server
