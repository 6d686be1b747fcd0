// SPDX-License-Identifier: Apache-2.0
// The rules of lint.h, and what they share.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "checker/domain.h"
#include "checker/geometry/arrangement.h"
#include "checker/geometry/box_tree.h"
#include "checker/geometry/contacts.h"
#include "checker/lint/faults.h"
#include "checker/lint/snapped_domain.h"

namespace weft::check {

struct LintContext {
  const Domain& domain;
  bool shared_points = false;
  SnappedDomain snapped;
  BoxTree tree;  // of the snapped segments
  // Places on the inside of segments, to rounding; sorted, distinct.
  std::vector<Contacts::Touch> touches{};
  std::vector<Contacts::Crossing> crossings{};  // sorted
  // Of the snapped segments, and links across what lies within the merging distance; none if the
  // segments meet too often. Vertices are places and crossings.
  std::optional<Arrangement> arrangement{};
  std::vector<std::vector<std::uint32_t>> covering{};  // areas per face; empty without areas

  Offender segment(std::uint32_t s) const { return {Offender::What::kSegment, snapped.origin[s]}; }
  Offender point(std::uint32_t place) const {
    return {Offender::What::kPoint, snapped.point_at[place]};
  }
  // Whether both segments are borders, of two polygons.
  bool of_two_areas(std::uint32_t s, std::uint32_t t) const {
    return snapped.areas[s] != 0 && snapped.areas[t] != 0 && snapped.areas[s] != snapped.areas[t];
  }
};

// Whether the foot of p on the segment from a to b is strictly between them.
bool is_beside(Vec2 p, Vec2 a, Vec2 b);
// From p to the segment from a to b.
double distance(Vec2 p, Vec2 a, Vec2 b);

// Crossings, junctions, segments that coincide, points and segments given twice.
void judge_meetings(const LintContext& context, Faults& faults);
// Per place, whether it is an open end. REQUIRES: there is an arrangement.
std::vector<char> judge_ends(const LintContext& context, Faults& faults);
// Points near points and segments. `is_open`: those of judge_ends, or empty.
void judge_distances(const LintContext& context, const std::vector<char>& is_open, Faults& faults);
// Angles, faces, polygons that overlap. REQUIRES: there is an arrangement.
void judge_faces(const LintContext& context, Faults& faults);
// REQUIRES: there is an arrangement.
void judge_seeds(const LintContext& context, Faults& faults);

}  // namespace weft::check
