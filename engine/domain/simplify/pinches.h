// SPDX-License-Identifier: Apache-2.0
// Opens pinches: places where a cut channel has left corners of several shores on one point, which
// would be one vertex of the domain. Models cannot walk a boundary that passes a vertex twice.
//
// Of the corners of water in one place, the widest stays; each other one moves into its water,
// along the bisector of its angle: by half the finest length, or by half of that, and so on, until
//   - the triangles of the corner's water keep their orientation, so that no lines cross (decided
//     exactly);
//   - its lines stay within the finest length of the original lines with their markers, and so does
//     all that becomes land;
//   - no angle at the corner's neighbours falls below 45 degrees and below what it was; if nothing
//     else is left, this is dropped.
// Places where lines of the original meet stay as they are.
#pragma once

#include <cstdint>

#include "engine/domain/simplify/line_graph.h"
#include "engine/domain/simplify/near_lines.h"
#include "engine/domain/stop_poller.h"

namespace weft {

// Moves points of the graph, and sets the errors of their lines. Throws Stopped.
void open_pinches(LineGraph& graph, const NearLines& original, StopPoller& poller);

}  // namespace weft
