// SPDX-License-Identifier: Apache-2.0
// Floor plans as drawing programs export them, each from a seed: a house turned by some angle,
// divided by partitions that end on walls, with doors, and columns in some rooms.
//
//   Pslg plan = floor_plan({.seed = 7, .offset = 1e6, .decimals = 4});
//
// The walls are not split where partitions end on them: the end is computed, turned, shifted and
// rounded by itself, as an export does, so it lies on its wall up to rounding only. The same seed
// gives the same plan at every offset and number of decimals.
#pragma once

#include <cstdint>

#include "weft/pslg.h"

namespace weft {

inline constexpr int kUnrounded = -1;

struct FloorPlan {
  std::uint64_t seed = 0;
  double offset = 0;          // of the house's corner, in x; the y coordinate is at 3 times as much
  int decimals = kUnrounded;  // that every coordinate is rounded to
};

// In metres: a house of 12 to 40 by 8 to 24, rooms of 2 at least. Columns are holes.
Pslg floor_plan(const FloorPlan& plan);

}  // namespace weft
