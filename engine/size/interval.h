// SPDX-License-Identifier: Apache-2.0
// Bounds of a value over a box.
#pragma once

#include <limits>

namespace weft {

// Every value lies in [lo, hi], or is NaN if `may_be_nan`; lo > hi if all are NaN for certain. If
// lo == hi and there is no NaN, the value is the same everywhere.
struct Interval {
  double lo = -std::numeric_limits<double>::infinity();
  double hi = std::numeric_limits<double>::infinity();
  bool may_be_nan = false;
};

// NaN everywhere, for certain.
inline constexpr Interval kUndefined{std::numeric_limits<double>::infinity(),
                                     -std::numeric_limits<double>::infinity(), true};

}  // namespace weft
