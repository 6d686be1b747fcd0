// SPDX-License-Identifier: Apache-2.0
#include "files/bytes/number_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <string>

namespace weft::files {
namespace {

constexpr std::size_t kLongest = 1 << 10;  // no program writes a longer number

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// The text with the exponent as C++ writes it; empty if it has none of Fortran's forms.
std::string with_exponent(std::string_view text) {
  const std::size_t letter = text.find_first_of("dD");
  if (letter != std::string_view::npos) {
    std::string out(text);
    out[letter] = 'e';
    return out;
  }
  const std::size_t sign = text.find_last_of("+-");
  constexpr std::size_t kDigits = 3;
  if (sign == std::string_view::npos || text.size() != sign + 1 + kDigits) return "";
  if (text.substr(0, sign).find('.') == std::string_view::npos) return "";
  return std::string(text.substr(0, sign)) + "e" + std::string(text.substr(sign));
}

std::optional<double> plain(std::string_view digits) {
  double value = 0;
  const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (end != digits.data() + digits.size() || problem == std::errc::invalid_argument)
    return std::nullopt;
  // from_chars reports an underflow like an overflow.
  if (problem == std::errc::result_out_of_range)
    value = std::strtod(std::string(digits).c_str(), nullptr);
  if (!std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

std::optional<double> real_of(std::string_view text) {
  const bool plus = text.starts_with('+');
  if (plus) text.remove_prefix(1);
  const bool is_number = !text.empty() && text.size() <= kLongest &&
                         (is_digit(text[0]) || text[0] == '.' || (text[0] == '-' && !plus));
  if (!is_number) return std::nullopt;
  if (const auto value = plain(text)) return value;
  const std::string changed = with_exponent(text);
  return changed.empty() ? std::nullopt : plain(changed);
}

std::optional<double> real_with_comma_of(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos) return real_of(text);
  if (text.size() > kLongest || text.find('.') != std::string_view::npos) return std::nullopt;
  std::string changed(text);
  changed[comma] = '.';
  return real_of(changed);
}

std::optional<std::int64_t> whole_of(std::string_view text) {
  if (const auto value = integer_of(text)) return value;
  constexpr double kLargest = 9007199254740992;  // up to it, all whole numbers are doubles
  const auto value = real_of(text);
  if (!value || std::abs(*value) > kLargest || *value != std::nearbyint(*value))
    return std::nullopt;
  return static_cast<std::int64_t>(*value);
}

std::optional<std::int64_t> integer_of(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  std::int64_t value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || problem != std::errc() || end != text.data() + text.size())
    return std::nullopt;
  return value;
}

}  // namespace weft::files
