// SPDX-License-Identifier: Apache-2.0
// The honest end of a mesh that is not what was asked for.
#pragma once

#include <optional>

#include "engine/base/error.h"
#include "engine/output/summary.h"

namespace weft {

// kBoundsNotMet if a triangle of a finished mesh misses a bound without excuse: with how many,
// which bound, why, and where the first one is.
//
//   12 triangles miss the minimum angle of 20 degrees because double precision ends; the first is
//   at (0.25, 1e+06)
std::optional<Error> bounds_error(const Summary& summary, double min_angle_deg);

}  // namespace weft
