// SPDX-License-Identifier: Apache-2.0
// Finds features of a domain that are so near to each other that a mesher may, or must, merge them.
//
// T is the merging distance (tolerance.h). A domain without features nearer than T leaves no
// choice: its points and segments must be in the mesh where they are, to rounding.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "checker/domain.h"
#include "checker/domain/tolerance.h"
#include "checker/geometry/contacts.h"

namespace weft::check {

struct NearFeatures {
  // In units of T. A feature that merging has moved, by at most kMaxBend, may meet the next vertex
  // within 1.
  static constexpr double kReach = kMaxBend + 2;

  double merging_distance = 0;  // T
  double rounding = 0;          // on_segment_tolerance
  // Per point: whether another one, at another place, is within T of it.
  std::vector<char> may_move;
  // Per segment: how far its chain may run beside it. More than rounding if a point or a
  // crossing that is not on the segment is within T of it, or within kReach * T if others bend
  // to that point; if an end may move; or if it passes where a bent segment crosses another one.
  std::vector<double> bend;
  // Features nearer than T, which must be merged: pairs of points, and points beside segments.
  std::vector<std::array<std::uint32_t, 2>> points;
  std::vector<Contacts::Touch> touches;
  bool any = false;  // whether something may move or be bent

  bool is_bent(std::uint32_t segment) const { return bend[segment] > rounding; }
};

// A point or a crossing within a few units in the last place of a segment does not count
// (gaps.h), unless segments cross there at a small angle, because their vertex may be farther off.
// REQUIRES: a domain that judge_domain accepts, and all of its contacts.
NearFeatures find_near_features(const Domain& domain, const Contacts& contacts);

}  // namespace weft::check
