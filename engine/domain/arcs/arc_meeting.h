// SPDX-License-Identifier: Apache-2.0
// How two pieces of arcs, or of segments, meet.
//
// Thread-safety: pure functions.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/base/vector.h"
#include "engine/domain/arcs/arc.h"
#include "weft/geometry.h"

namespace weft {

// An arc that turns by less than 180 degrees, or a straight segment, between two vertices.
struct ArcPiece {
  ArcPiece(std::uint32_t first, std::uint32_t last, Point start, Point end, double by);

  std::uint32_t a, b;  // vertices
  Point from, to;      // their places
  double bulge;        // 0 if it is straight
  double curvature;
  Vector tangent;  // at `from`, of length 1
  Point control;   // where the tangents meet

  // Its corners, counter-clockwise; two if rounding leaves no area.
  std::vector<Point> hull() const;
  // Of the hull over the chord.
  double height() const;
  // Whether a point is that near to the hull, or the piece, and between its ends.
  bool hull_is_near(Point p, double distance) const;
  bool is_near(Point p, double distance) const;
  // At an end, away from it.
  Vector tangent_from(std::uint32_t vertex) const;
};

// Whether the hulls meet elsewhere than at a common vertex: exact, for the rounded corners.
// REQUIRES: the pieces have at most one vertex in common.
bool hulls_meet(const ArcPiece& p, const ArcPiece& q);

// Where the pieces cross, or touch to within the margin, twice as far from the ends of both; of two
// places, the one nearer to p.from.
std::optional<Point> crossing_of(const ArcPiece& p, const ArcPiece& q, double margin);

// Whether they leave the vertex in one direction, to 1e-4 radians.
bool leave_together(const ArcPiece& p, const ArcPiece& q, std::uint32_t vertex);

}  // namespace weft
