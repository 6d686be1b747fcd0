// SPDX-License-Identifier: Apache-2.0
#include "engine/refine/area_bound.h"

#include <charconv>
#include <cmath>

namespace weft {

std::string bad_size_message(const BadSize& bad) {
  const auto text = [](double value) {
    if (std::isnan(value)) return std::string("not a number");  // its sign is noise
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value);
    return std::string(buffer, end.ptr);
  };
  return "the size at (" + text(bad.at.x) + ", " + text(bad.at.y) + ") is " + text(bad.value) +
         ", but must be positive and finite";
}

}  // namespace weft
