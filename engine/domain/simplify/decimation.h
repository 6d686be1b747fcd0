// SPDX-License-Identifier: Apache-2.0
// Takes nodes out of chains where their lines are too short, the least important first.
//
// A node v between u and w goes if the line uw may take the place of uv and vw:
//   - no other point lies in the triangle uvw, on its border, or nearer than the domain's tolerance
//     to uw. So no line crosses another, all stays on its side of the chain, and so does the order
//     of what meets in a point (decided exactly);
//   - every point of uw is within the error allowed there of the original lines with its marker,
//     and every point of the chain that it replaces within the same distance of uw. If the chain
//     bounds the domain, it is enough that every point of the triangle is within that error of the
//     original lines, and every point of uw of those with its marker;
//   - it makes no angle inside the domain that is below a bound and below what was there.
// The new line has the marker of the two; of two markers, that of the longer line if it may have
// it. A node is tried if one of its lines is shorter than the finest length at its ends, or if it
// was no corner of the original. The order is that of the errors, relative to what is allowed.
//
// Why the error bounds both ways. Let d be the largest distance of a node of the chain from u to w
// to the line uw: as distances to a line are convex, no point of the chain is farther from it. A
// perpendicular at any point of uw meets the chain, because the chain leads from its one end to the
// other; so no point of uw is farther than d from the chain. To the original lines it is the
// chain's own error more.
#pragma once

#include <cstdint>

#include "engine/domain/simplify/line_graph.h"
#include "engine/domain/simplify/near_lines.h"
#include "engine/domain/stop_poller.h"

namespace weft {

// Rings that were dropped, by what was inside them.
struct Dropped {
  std::uint64_t islands = 0;  // not meshed, and are now
  std::uint64_t waters = 0;   // meshed, and are no longer
};

// Drops rings that hold nothing and enclose less than an equilateral triangle of the finest edges
// there, then takes nodes out, as far as errors stay within `share` of the finest length. REQUIRES:
// 0 < share <= 1. Throws Stopped.
Dropped decimate(LineGraph& graph, const NearLines& original, double share, double tolerance,
                 StopPoller& poller);

}  // namespace weft
