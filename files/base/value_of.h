// SPDX-License-Identifier: Apache-2.0
// Numbers from texts that people write.
#pragma once

#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

namespace weft::files {

// The number that a text is; nullopt if it has another form, or is out of range. A double is
// rounded to the nearest; integers may be hexadecimal.
template <class T>
std::optional<T> value_of(const std::string& text) {
  static_assert(std::is_same_v<T, double> || (std::is_integral_v<T> && !std::is_same_v<T, bool>));
  char* end = nullptr;
  const auto is_whole = [&] { return !text.empty() && end == text.c_str() + text.size(); };
  if constexpr (std::is_same_v<T, double>) {
    const double value = std::strtod(text.c_str(), &end);
    return is_whole() ? std::optional(value) : std::nullopt;
  } else {
    // Of an unsigned number, strtoull takes a minus for a wrap.
    if (std::is_unsigned_v<T> && text.find('-') != std::string::npos) return std::nullopt;
    errno = 0;
    std::conditional_t<std::is_signed_v<T>, std::int64_t, std::uint64_t> value = 0;
    if constexpr (std::is_signed_v<T>)
      value = std::strtoll(text.c_str(), &end, 0);
    else
      value = std::strtoull(text.c_str(), &end, 0);
    if (!is_whole() || errno == ERANGE || !std::in_range<T>(value)) return std::nullopt;
    return static_cast<T>(value);
  }
}

}  // namespace weft::files
