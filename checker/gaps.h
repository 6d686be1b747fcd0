// SPDX-License-Identifier: Apache-2.0
// Junctions that rounding has opened. Where a segment was meant to end on another one that is not
// parallel to an axis, its end, a pair of doubles, is almost never exactly on it; half of the time
// it stops short, and the faces on its two sides are one. So an end within kSnapUlps units in the
// last place of a segment (of that segment's largest coordinate) counts as on it, as it does for
// the mesher: a link, a segment as short as that, is added from the end across the other segment.
// Links bound faces; they are no segments to be found in the mesh.
#pragma once

#include <array>
#include <vector>

#include "checker/domain.h"

namespace weft::check {

inline constexpr double kSnapUlps = 4;

// REQUIRES: a domain that judge_domain accepts.
std::vector<std::array<Vec2, 2>> links_across_gaps(const Domain& domain);

}  // namespace weft::check
