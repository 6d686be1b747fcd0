// SPDX-License-Identifier: Apache-2.0
// The body of a form (RFC 7578), as curl -F sends it.
//
//   if (is_form(content_type)) auto parts = parts_of(content_type, body);
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace weft::server {

struct FormPart {
  std::string name;
  std::optional<std::string> filename{};  // of a file
  std::string content_type{};
  std::string_view body{};  // within that of the form
};

bool is_form(std::string_view content_type);

// In their order. The error says what is wrong: there is no boundary, the last one is missing, a
// part has no name, or there are more than 100.
tl::expected<std::vector<FormPart>, std::string> parts_of(std::string_view content_type,
                                                          std::string_view body);

}  // namespace weft::server
