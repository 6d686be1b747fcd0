// SPDX-License-Identifier: Apache-2.0
#include "server/observe/log_json.h"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>

namespace weft::server {
namespace {

std::string in_json(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

// Takes a quoted text, which begins after the quote, from the rest of a line. Returns nullopt
// unless log_value made it.
std::optional<std::string> take_quoted(std::string_view& rest) {
  std::string text;
  while (!rest.empty()) {
    const char c = rest.front();
    rest.remove_prefix(1);
    if (c == '"') return text;
    if (c != '\\') {
      text += c;
      continue;
    }
    if (rest.empty()) return std::nullopt;
    const char escaped = rest.front();
    rest.remove_prefix(1);
    if (escaped == '"' || escaped == '\\') {
      text += escaped;
    } else if (escaped == 'n') {
      text += '\n';
    } else if (escaped == 'x' && rest.size() >= 2) {
      unsigned char byte = 0;
      const auto [end, error] = std::from_chars(rest.data(), rest.data() + 2, byte, 16);
      if (error != std::errc() || end != rest.data() + 2) return std::nullopt;
      text += static_cast<char>(byte);
      rest.remove_prefix(2);
    } else {
      return std::nullopt;
    }
  }
  return std::nullopt;
}

// Takes a value from the rest of a line; returns it as JSON.
std::optional<std::string> take_value(std::string_view& rest) {
  if (!rest.starts_with('"')) {
    const std::string_view word = rest.substr(0, rest.find(' '));
    rest.remove_prefix(word.size());
    return is_number(word) ? std::string(word) : in_json(word);
  }
  rest.remove_prefix(1);
  const auto text = take_quoted(rest);
  if (!text) return std::nullopt;
  return in_json(*text);
}

std::optional<std::string> object_of(std::string_view rest) {
  std::string json = "{";
  while (!rest.empty()) {
    const std::size_t equals = rest.find('=');
    const std::string_view key = rest.substr(0, equals);
    if (equals == std::string_view::npos || key.empty() || key.find(' ') != key.npos)
      return std::nullopt;
    rest.remove_prefix(equals + 1);
    const auto value = take_value(rest);
    if (!value || (!rest.empty() && rest.front() != ' ')) return std::nullopt;
    rest.remove_prefix(std::min<std::size_t>(1, rest.size()));
    json += (json.size() > 1 ? "," : "") + in_json(key) + ":" + *value;
  }
  return json + "}";
}

// Takes digits, and returns their number.
std::size_t take_digits(std::string_view& rest) {
  const auto end =
      std::find_if(rest.begin(), rest.end(), [](char c) { return c < '0' || c > '9'; });
  const auto count = static_cast<std::size_t>(end - rest.begin());
  rest.remove_prefix(count);
  return count;
}

}  // namespace

std::string json_of_fields(std::string_view line) {
  if (auto object = object_of(line)) return *object;
  return "{\"message\":" + in_json(line) + "}";
}

bool is_number(std::string_view text) {
  if (text.starts_with('-')) text.remove_prefix(1);
  const bool zero_first = text.starts_with('0');
  const std::size_t digits = take_digits(text);
  if (digits == 0 || (zero_first && digits > 1)) return false;
  if (text.starts_with('.')) {
    text.remove_prefix(1);
    if (take_digits(text) == 0) return false;
  }
  if (text.starts_with('e') || text.starts_with('E')) {
    text.remove_prefix(1);
    if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
    if (take_digits(text) == 0) return false;
  }
  return text.empty();
}

}  // namespace weft::server
