// SPDX-License-Identifier: Apache-2.0
// A planar straight-line graph: what a client asks to be meshed.
//
// Points and segments bound the domain. Input may be dirty: segments may cross, overlap or repeat,
// points may coincide; the mesh resolves all of it. What is meshed:
//   - Fill::kSeeds: every bounded face of the segments, less the faces that a hole seed floods
//     (flooding stops at segments). This is Triangle's rule.
//   - Fill::kEvenOdd: the points whose rays to infinity cross the segments an odd number of times
//     (GeoJSON polygons, whose holes are rings). Coincident segments count once each, so two
//     copies cancel. If segments do not close to rings, the ray that crosses the fewest decides.
//     Hole seeds carve as above, on top.
//   - Fill::kUnion: the faces that an area covers, less those that a hole seed floods.
// An area is what its segments enclose: the points whose rays to infinity cross them an odd number
// of times. Areas may overlap, nest and touch in any way. If there are areas, Fill::kEvenOdd means
// the faces that an odd number of them covers. Whatever the fill, a face that an area with
// `is_hole` covers is carved away, and the areas that cover a face decide its region and bound;
// seeds come after areas. Points outside the meshed faces are dropped; a point inside that no
// segment names becomes a vertex.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "weft/geometry.h"

namespace weft {

// Magnitudes of coordinates other than 0, so that products of four of them stay in range.
inline constexpr double kMinMagnitude = 1e-100;
inline constexpr double kMaxMagnitude = 1e50;
// So that vertices and triangles can be numbered in 32 bits.
inline constexpr std::uint64_t kMaxPoints = std::uint64_t{1} << 28;
inline constexpr std::uint64_t kMaxSegments = std::uint64_t{1} << 30;

inline constexpr double kMaxBulge = 1e6;  // all but 2.3e-4 degrees of a circle

struct Segment {
  std::uint32_t a = 0;  // index into Pslg::points
  std::uint32_t b = 0;
  std::int32_t marker = 0;     // carried by every mesh edge of this segment
  std::uint32_t area = kNone;  // index into Pslg::areas if it is part of the border of one
};

// Makes a segment an arc of a circle, which its edges in the mesh approach as they get shorter:
// they turn by 60 degrees at most, their vertices lie on the arc, and no vertex lies between the
// two.
struct Arc {
  std::uint32_t segment = 0;  // index into Pslg::segments; at most one arc each
  // The tangent of a quarter of the angle by which the arc turns from `a` to `b`, as in DXF: 1 for
  // a half circle, above 0 if it turns left. The centre is left of the line from a to b for 0 <
  // bulge < 1. At most kMaxBulge in magnitude; 0 for a straight segment.
  double bulge = 0;
};

// REQUIRES: its segments close to rings: an even number of their ends is at every point.
struct Area {
  // Of all areas that cover a face and have a region, the one with the highest priority gives the
  // face its region; of several, the smallest; of several of one size, to 30 bits, the first.
  std::optional<std::int32_t> region = std::nullopt;
  std::int32_t priority = 0;
  std::optional<double> max_area = std::nullopt;  // > 0; the least of all that cover a face holds
  bool is_hole = false;  // carves what it covers away, and has no other effect
};

// Floods the face that `at` lies in, up to the segments. Its id takes the place of the areas'; the
// smaller bound holds.
struct RegionSeed {
  Point at;
  std::int32_t id = 0;  // carried by every triangle of the face; 0 elsewhere
  std::optional<double> max_area = std::nullopt;  // > 0, in squared units
};

enum class Fill : std::uint8_t { kSeeds, kEvenOdd, kUnion };

struct Pslg {
  std::vector<Point> points{};
  std::vector<Segment> segments{};
  std::vector<Point> holes{};
  std::vector<RegionSeed> regions{};
  std::vector<Area> areas{};
  std::vector<Arc> arcs{};
  Fill fill = Fill::kSeeds;
  // Features nearer than this are merged first: points, points and segments, crossings. In the
  // units of the coordinates, 0 or more. 0: only what double precision cannot keep apart.
  double snap = 0;
};

}  // namespace weft
