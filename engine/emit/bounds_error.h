// SPDX-License-Identifier: Apache-2.0
// The error of a mesh that is not what was asked for.
#pragma once

#include <optional>

#include "weft/error.h"
#include "weft/mesh.h"

namespace weft {

// kBoundsNotMet if triangles of a finished mesh miss a bound without exemption; nullopt otherwise.
// The message says how many, which bound, why, and where the first one is.
//
//   12 triangles miss the minimum angle of 20 degrees because double precision ends; the first is
//   at (0.25, 1e+06)
std::optional<Error> bounds_error(const Summary& summary, double min_angle_deg);

}  // namespace weft
