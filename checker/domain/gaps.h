// SPDX-License-Identifier: Apache-2.0
// Junctions that rounding has opened. If a segment was meant to end on another one that is not
// parallel to an axis, its end, a pair of doubles, is almost never exactly on it; half of the time
// it stops short, and the faces on its two sides are one. So an end within kSnapUlps units in the
// last place of a segment (of that segment's largest coordinate) counts as on it, as it does for
// the mesher: a link, an equally short segment, is added from the end across the other segment. So
// does any other point: a tip between two segments ends at a point that counts as on both.
// Links bound faces; they need not be in the mesh. (For junctions that are open by more than
// rounding, but less than the merging distance, see bent_domain.h.)
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "checker/domain.h"

namespace weft::check {

inline constexpr double kSnapUlps = 4;

// How near an end must be to the segment a-b.
double snap_distance(Vec2 a, Vec2 b);

// A point near p on or beyond the line a-b, searched from this distance on; nullopt if p is on the
// line.
std::optional<Vec2> across(Vec2 p, Vec2 a, Vec2 b, double distance);

// REQUIRES: a domain that judge_domain accepts.
std::vector<std::array<Vec2, 2>> links_across_gaps(const Domain& domain);

}  // namespace weft::check
