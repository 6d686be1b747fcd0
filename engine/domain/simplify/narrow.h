// SPDX-License-Identifier: Apache-2.0
// Closes water that is narrower than the finest length, and opens such land. "Water" is what is
// meshed, "land" is what is not; regions and lines inside the domain stay as they are, and so does
// all that touches them.
//
// A triangle of the constrained Delaunay triangulation of the lines is narrow if a circle around
// its corners has a diameter below 1.118 of the finest length there, and no angle is above 150
// degrees: if points are dense along the lines, that is a place where no disk of this diameter
// fits. Points are made dense where a corner is nearer to a line than the finest length, and where
// lines meet at less than 45 degrees. Then:
//   1. inlets: a narrow triangle of water with two sides on the border becomes land, and so on from
//      the head of an inlet to its mouth;
//   2. channels: a narrow triangle of water with one side on the border becomes land, the narrowest
//      first, which cuts the channel; then both stumps go as by 1. Straits stay (straits.h). Of
//      each water that is cut into several, the heaviest stays and the others are dropped;
//   3. spits and islands: as by 1, with water and land exchanged. Land is never cut.
// A new line has the marker of a line that the triangle replaces, or of one at its ends, if all of
// it is within the finest length of the original lines with that marker. No triangle changes that
// has a point farther than that from all original lines, or a side without such a marker.
//
// Places that end in a held point, where a marker ends or lines meet, are left: 1 stops there, and
// the widest way there is a strait.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "engine/domain/simplify/decimation.h"
#include "engine/domain/simplify/line_graph.h"
#include "engine/domain/simplify/near_lines.h"
#include "engine/domain/stop_poller.h"

namespace weft {

struct Narrowed {
  std::uint64_t changed = 0;  // triangles
  std::vector<Point> cuts;    // of each channel that was cut, a point in the place
  std::uint64_t cut_off = 0;  // waters behind them, which were dropped
  std::uint64_t straits = 0;  // that are narrow and stay
  Dropped dropped;            // by 1 and 3, to the last triangle
};

// `finest_at` is asked at new points, where the least of it and of what the ends of their line have
// counts. Throws Stopped.
Narrowed close_narrow_places(LineGraph& graph, const NearLines& original,
                             const std::function<double(Point)>& finest_at, StopPoller& poller);

}  // namespace weft
