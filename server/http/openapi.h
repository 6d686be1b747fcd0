// SPDX-License-Identifier: Apache-2.0
// The description of the routes, in OpenAPI 3.1.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace weft::server {

struct RouteText {
  std::string_view method;                                    // in lower case
  std::string_view path;                                      // with {parameters}
  std::string_view about;                                     // a sentence without a full stop
  enum class Answer { kMesh, kJson } answer = Answer::kJson;  // to kMesh belongs a domain
};

std::string openapi(std::span<const RouteText> routes);

}  // namespace weft::server
