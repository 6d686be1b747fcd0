// SPDX-License-Identifier: Apache-2.0
// A domain without arcs: each is a polyline instead. The distance to an arc, of which sizes may
// make use, is that to this polyline, by definition.
#pragma once

#include <cstdint>
#include <vector>

#include "checker/domain.h"

namespace weft::check {

// A domain without arcs, and for each of its segments the one that was given that it is, or is a
// piece of.
struct StraightDomain {
  Domain domain;
  std::vector<std::uint32_t> origin;
};

// From one point to another, as part of a segment that was given.
struct SegmentPiece {
  std::uint32_t segment;
  std::uint32_t from, to;
};

// The given domain with these pieces for its segments, and with `added` after its points.
StraightDomain straight_domain(const Domain& given, const std::vector<Vec2>& added,
                               const std::vector<SegmentPiece>& pieces);

// Per segment, its bulge; 0 if it is straight, or if judge_domain refuses the arc.
std::vector<double> bulges_of(const Domain& domain);

// Into how many equal pieces that turn by no more than `most` degrees a turn, in radians, is cut.
std::uint32_t pieces_of(double turn, double most);

// The inner points of the polyline: between equal pieces of 2 degrees at most. None for a bulge of
// 0.
std::vector<Vec2> flattened(Vec2 from, Vec2 to, double bulge);

// REQUIRES: a domain that judge_domain accepts.
StraightDomain flattened(const Domain& domain);

}  // namespace weft::check
