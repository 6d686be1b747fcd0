// SPDX-License-Identifier: Apache-2.0
#include "files/base/text.h"

#include <charconv>
#include <cmath>
#include <cstdio>

namespace weft::files {
namespace {

constexpr char kDigits[] = "0123456789abcdef";

}  // namespace

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 32;
  std::string out = "'";
  for (const char c : text.substr(0, kLongest)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7f) {
      out += c;
    } else {
      out += "\\x";
      out += kDigits[byte >> 4];
      out += kDigits[byte & 15];
    }
  }
  out += text.size() > kLongest ? "...'" : "'";
  return out;
}

std::string in_quotes(const std::vector<std::string>& texts) {
  constexpr std::size_t kMax = 24;
  std::string list;
  for (std::size_t i = 0; i < texts.size() && i < kMax; ++i)
    list += (i == 0 ? "" : ", ") + in_quotes(texts[i]);
  return texts.size() > kMax ? list + ", ..." : list;
}

std::string harmless(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    out += (byte < 0x20 && c != '\n') || byte == 0x7f ? '?' : c;
  }
  return out;
}

std::string shortest(double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  return {buffer, result.ptr};
}

std::string coordinates(double x, double y) {
  std::string out = shortest(x).insert(0, 1, '(');
  return out.append(", ").append(shortest(y)).append(1, ')');
}

std::string with_separators(std::uint64_t value) {
  const std::string digits = std::to_string(value);
  std::string out;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) out += ',';
    out += digits[i];
  }
  return out;
}

std::string digits(double value, int count) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", count, value);
  return text;
}

std::string two_digits_above(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 1);
  return digits(unit * (std::floor(value / unit) + 1), 6);
}

std::string seconds_text(double seconds) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3f s", seconds);
  return buffer;
}

std::string bytes_text(std::uint64_t bytes) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.1f MB", static_cast<double>(bytes) / 1e6);
  return buffer;
}

std::string hex(std::string_view bytes) {
  std::string out;
  out.reserve(bytes.size() * 2);
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    out += kDigits[byte >> 4];
    out += kDigits[byte & 15];
  }
  return out;
}

}  // namespace weft::files
