// SPDX-License-Identifier: Apache-2.0
// Finds the faults of a domain, all at once. Crossings, touches and faces are exact; thresholds
// below say what is near, small or thin.
//
// A mesher merges what is nearer than T = max(snap, 2^-40 of the largest coordinate)
// (domain/tolerance.h), so nothing that vanishes by that is a fault: a domain is judged as if its
// places within T were one. What lies within T of the inside of a segment counts as on it, but a
// junction is told only if it is there without a snap.
//
// Polygons may share borders and nest: segments of two polygons that coincide, touch or cross are
// no faults by themselves, and lines may run along borders, to mark them, and end inside polygons.
// Time and memory are O(n log n) for n segments and contacts.
#pragma once

#include <cstddef>

#include "checker/domain.h"
#include "checker/lint/faults.h"

namespace weft::check {

// Open ends nearer than this part of the domain's extent are a gap, and an end as near to a
// segment, if it is nearer than its own segment is long.
inline constexpr double kGapOfExtent = 1e-3;
// Points, and points and segments, are near if their distance is below this part of the shortest
// segment at either.
inline constexpr double kNearOfLength = 1e-4;
inline constexpr double kSmallAngleDeg = 1;
// A face is a sliver if its mean width is below this part of its mean edge.
inline constexpr double kSliverOfEdge = 1e-3;
// If segments meet more often, faces and open ends are not looked at.
inline constexpr std::size_t kMaxMeetings = 200'000;

struct LintResult {
  Faults faults;  // by kind, then in the order of the domain
  bool complete = true;
};

// `shared_points`: whether segments share points by their numbers, so that two points at one place
// are a fault. REQUIRES: a domain that judge_domain accepts.
LintResult lint(const Domain& domain, bool shared_points);

}  // namespace weft::check
