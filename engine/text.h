// SPDX-License-Identifier: Apache-2.0
// Numbers as error messages spell them.
#pragma once

#include <charconv>
#include <string>

namespace weft {

// The shortest decimal that reads back as the same double.
inline std::string text(double value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value);
  return {buffer, end.ptr};
}

}  // namespace weft
