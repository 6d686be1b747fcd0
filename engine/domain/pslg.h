// SPDX-License-Identifier: Apache-2.0
// A planar straight-line graph: what a client asks to be meshed.
//
// Points and segments bound the domain. Input may be dirty: segments may cross, overlap or repeat,
// points may coincide; `triangulate` (domain.h beside this file) resolves all of it. What is
// meshed:
//   - Fill::kSeeds: every bounded face of the segments, less the faces that a hole seed floods
//     (flooding stops at segments). This is Triangle's rule.
//   - Fill::kEvenOdd: the points whose rays to infinity cross the segments an odd number of times
//     (GeoJSON polygons, whose holes are rings). Coincident segments count once each, so two
//     copies cancel. If segments do not close to rings, the ray that crosses the fewest decides.
//     Hole seeds carve as above, on top.
// Points outside the meshed faces are dropped; a point inside that no segment names becomes a
// vertex.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/base/geometry.h"

namespace weft {

struct Segment {
  std::uint32_t a = 0;  // index into Pslg::points
  std::uint32_t b = 0;
  std::int32_t marker = 0;  // carried by every mesh edge of this segment
};

// Floods the face that `at` lies in, up to the segments.
struct RegionSeed {
  Point at;
  std::int32_t id = 0;             // carried by every triangle of the face; 0 elsewhere
  std::optional<double> max_area;  // > 0, in squared units; combined with the size field by min
};

enum class Fill : std::uint8_t { kSeeds, kEvenOdd };

struct Pslg {
  std::vector<Point> points;
  std::vector<Segment> segments;
  std::vector<Point> holes;
  std::vector<RegionSeed> regions;
  Fill fill = Fill::kSeeds;
  // Features nearer than this are merged first: points, points and segments, crossings (see
  // arrangement.h). In the units of the coordinates, 0 or more. 0: only what double precision
  // cannot keep apart.
  double snap = 0;
};

}  // namespace weft
