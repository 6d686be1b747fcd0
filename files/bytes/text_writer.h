// SPDX-License-Identifier: Apache-2.0
// Lines of numbers in text formats.
#pragma once

#include <cstdint>
#include <type_traits>

#include "files/base/atomic_file.h"

namespace weft::files {

// Writes the fields with blanks between them: numbers as the shortest text that reads back the
// same, and texts as they are.
template <class First, class... Rest>
void put_line(OutputFile& file, const First& first, const Rest&... rest) {
  const auto put = [&file](const auto& field) {
    using Field = std::decay_t<decltype(field)>;
    if constexpr (std::is_floating_point_v<Field>) {
      file.number(static_cast<double>(field));
    } else if constexpr (std::is_integral_v<Field>) {
      file.number(static_cast<std::int64_t>(field));
    } else {
      file.put(field);
    }
  };
  put(first);
  ((file.put(' '), put(rest)), ...);
  file.put('\n');
}

}  // namespace weft::files
