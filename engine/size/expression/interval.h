// SPDX-License-Identifier: Apache-2.0
// Bounds of a value over a box.
#pragma once

#include <limits>

namespace weft {

// Every value lies in [lo, hi], unless it is NaN, which only `may_be_nan` admits. lo == hi with no
// NaN: the value is the same everywhere.
struct Interval {
  double lo = -std::numeric_limits<double>::infinity();
  double hi = std::numeric_limits<double>::infinity();
  bool may_be_nan = false;
};

}  // namespace weft
