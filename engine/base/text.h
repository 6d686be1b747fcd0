// SPDX-License-Identifier: Apache-2.0
// Numbers as error messages spell them.
#pragma once

#include <charconv>
#include <cmath>
#include <string>

namespace weft {

// The shortest decimal that reads back as the same double. Both signs of a NaN give the same text.
inline std::string text(double value) {
  if (std::isnan(value)) return "not a number";
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value);
  return {buffer, end.ptr};
}

// The same to four digits: for a reader who compares magnitudes.
inline std::string rough_text(double value) {
  char buffer[32];
  const auto end =
      std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 4);
  return {buffer, end.ptr};
}

}  // namespace weft
