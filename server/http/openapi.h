// SPDX-License-Identifier: Apache-2.0
// The description of the routes, in OpenAPI 3.1.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "server/http/mesh_wish.h"

namespace weft::server {

struct RouteText {
  std::string_view method;  // in lower case
  std::string_view path;    // with {parameters}
  std::string_view about;   // a sentence without a full stop
  ParameterUses uses = 0;   // of its parameters; of a domain: its body is one
  bool is_mesh = false;     // the answer; otherwise it is JSON
};

std::string openapi(std::span<const RouteText> routes);

}  // namespace weft::server
