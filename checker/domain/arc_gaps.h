// SPDX-License-Identifier: Apache-2.0
// Parts of arcs that the mesh lacks, because nothing beside them is meshed: the checker's own
// chords stand for them.
#pragma once

#include <cstdint>
#include <vector>

#include "checker/domain.h"
#include "checker/geometry/circular_arc.h"

namespace weft::check {

// A chord of an arc.
struct ArcPiece {
  std::uint32_t segment;  // that was given, and is this arc
  const CircularArc* curve;
  std::uint32_t from, to;       // points
  double from_angle, to_angle;  // along the curve
  bool is_gap;                  // whether the mesh lacks it
};

// Cuts the gaps into chords of 5 degrees at most, and shorter ones where anything else comes
// between a chord and its arc: a segment, another chord, a point or a seed. (Where others cross an
// arc, some always do.) Adds points; `points` begins with those of the domain. `least`: what is no
// farther from its chord is not cut.
void cut_gaps(const Domain& domain, double least, std::vector<Vec2>& points,
              std::vector<ArcPiece>& pieces);

}  // namespace weft::check
