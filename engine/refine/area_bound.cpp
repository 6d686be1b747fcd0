// SPDX-License-Identifier: Apache-2.0
#include "engine/refine/area_bound.h"

#include "engine/base/text.h"

namespace weft {

Error bad_size_error(const BadSize& bad) {
  std::string message = "the size at (" + text(bad.at.x) + ", " + text(bad.at.y) + ") is " +
                        text(bad.value) + ", but must be positive and finite";
  for (const std::string& name : bad.size->undefined_at(bad.at))
    message += "; the field " + name + " is undefined there, see coalesce and defined";
  return {ErrorCode::kBadSizeValue, "size", std::move(message)};
}

}  // namespace weft
