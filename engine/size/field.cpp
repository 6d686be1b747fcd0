// SPDX-License-Identifier: Apache-2.0
#include "engine/size/field.h"

#include <algorithm>

namespace weft {

double Field::operator()(Point p) const noexcept {
  alignas(64) double x[kLanes];
  alignas(64) double y[kLanes];
  alignas(64) double out[kLanes];
  std::fill_n(x, kLanes, p.x);
  std::fill_n(y, kLanes, p.y);
  evaluate(kLanes, x, y, out);
  return out[0];
}

}  // namespace weft
