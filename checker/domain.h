// SPDX-License-Identifier: Apache-2.0
// The domain to be meshed, as the checker sees it: a planar straight-line graph with seeds.
// Coordinates are in one unit of the caller's choice; indices count from 0.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace weft::check {

struct Vec2 {
  double x = 0;
  double y = 0;
  friend bool operator==(const Vec2&, const Vec2&) = default;
};

// The order in which the checker numbers and sorts points: by x, then by y.
inline bool lexicographically_less(Vec2 p, Vec2 q) {
  return p.x < q.x || (p.x == q.x && p.y < q.y);
}

// Floods the face that `at` lies in, up to the segments; if seeds share a face, the last wins.
struct RegionSeed {
  Vec2 at;
  std::int32_t id = 0;
  std::optional<double> max_area;  // squared units
};

// A polygon, as the segments that name it draw it: what an odd number of them separates from
// infinity. Of all that cover a face and have a region, the one of the highest priority gives the
// face its region; of several, the smallest; of several of one size, to 30 bits, the first. The
// least bound of all holds.
struct Area {
  std::optional<std::int32_t> region;
  std::int32_t priority = 0;
  std::optional<double> max_area;  // squared units
  bool is_hole = false;            // carves what it covers away, and has no other effect
};

// Makes a segment an arc of a circle.
struct Arc {
  std::uint32_t segment = 0;  // index into segments; at most one arc each
  // The tangent of a quarter of the angle by which the arc turns from the segment's first point to
  // its second; above 0 if it turns left.
  double bulge = 0;
};

// Which faces of the segments' arrangement are meshed.
enum class Fill : std::uint8_t {
  kSeeds,  // every bounded face without a hole seed
  // Faces without a hole seed, an odd number of segments away from infinity; if there are areas,
  // faces that an odd number of them covers.
  kEvenOdd,
  kUnion,  // faces without a hole seed that an area covers
};

struct Domain {
  std::vector<Vec2> points;
  std::vector<std::array<std::uint32_t, 2>> segments;  // indices into points
  std::vector<std::int32_t> markers;                   // one per segment, or empty: all 0
  std::vector<Vec2> holes;
  std::vector<RegionSeed> regions;
  std::vector<Area> areas;
  std::vector<std::uint32_t>
      segment_areas;      // one per segment, or empty: 0, or 1 + an index into areas
  std::vector<Arc> arcs;  // all other segments are straight
  Fill fill = Fill::kSeeds;
  double snap = 0;  // features nearer than this must be merged (tolerance.h); at least 0
};

}  // namespace weft::check
