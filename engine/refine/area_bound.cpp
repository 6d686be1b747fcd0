// SPDX-License-Identifier: Apache-2.0
#include "engine/refine/area_bound.h"

#include <charconv>
#include <cmath>
#include <string>
#include <utility>

namespace weft {

Error bad_size_error(const BadSize& bad, std::string field) {
  const auto text = [](double value) {
    if (std::isnan(value)) return std::string("not a number");  // its sign is noise
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value);
    return std::string(buffer, end.ptr);
  };
  return {ErrorCode::kBadSizeValue, std::move(field),
          "the size at (" + text(bad.at.x) + ", " + text(bad.at.y) + ") is " + text(bad.value) +
              ", but must be positive and finite"};
}

}  // namespace weft
