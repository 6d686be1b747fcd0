// SPDX-License-Identifier: Apache-2.0
#include "engine/refine/area_bound.h"

#include "engine/base/text.h"

namespace weft {

Error bad_size_error(const BadSize& bad) {
  return {ErrorCode::kBadSizeValue, "size",
          "the size at (" + text(bad.at.x) + ", " + text(bad.at.y) + ") is " + text(bad.value) +
              ", but must be positive and finite"};
}

}  // namespace weft
