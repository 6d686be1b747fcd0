// SPDX-License-Identifier: Apache-2.0
// Paths of fields in a request, as a server's errors name them: "size.fields[2].name".
#pragma once

#include <charconv>
#include <cstddef>
#include <optional>
#include <string_view>
#include <system_error>

namespace weft::files {

// Whether `path` names the field `field`, or something in it.
inline bool is_within(std::string_view path, std::string_view field) {
  if (!path.starts_with(field)) return false;
  return path.size() == field.size() || path[field.size()] == '.' || path[field.size()] == '[';
}

// 2, if `path` is "size.fields[2].name" and `list` is "size.fields"; nullopt if the path names no
// entry of the list.
inline std::optional<std::size_t> index_in(std::string_view path, std::string_view list) {
  if (path.size() <= list.size() || !path.starts_with(list) || path[list.size()] != '[')
    return std::nullopt;
  const char* const digits = path.data() + list.size() + 1;
  const char* const end = path.data() + path.size();
  std::size_t index = 0;
  const auto [stop, problem] = std::from_chars(digits, end, index);
  if (problem != std::errc() || stop == end || *stop != ']') return std::nullopt;
  return index;
}

}  // namespace weft::files
