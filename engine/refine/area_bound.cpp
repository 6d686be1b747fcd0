// SPDX-License-Identifier: Apache-2.0
#include "engine/refine/area_bound.h"

#include <cmath>

#include "engine/base/text.h"

namespace weft {

Error bad_size_error(const BadSize& bad) {
  const SizeFunction::Asked asked = bad.size->asked_at(bad.at);
  std::string message = asked.is_edge ? "the length of edges at (" : "the size at (";
  message += text(bad.at.x) + ", " + text(bad.at.y) + ") is " + text(asked.value) +
             ", but must be positive and finite";
  if (asked.value > 0 && std::isfinite(asked.value))
    message += ", and so must the area that it gives";
  for (const std::string& name : asked.undefined)
    message += "; the field " + name + " is undefined there, see coalesce and defined";
  return {ErrorCode::kBadSizeValue, "size", std::move(message), bad.at};
}

}  // namespace weft
