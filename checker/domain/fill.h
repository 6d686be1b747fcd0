// SPDX-License-Identifier: Apache-2.0
// Which faces of the arrangement are meshed, and in which region each lies.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "checker/domain/bent_domain.h"
#include "checker/geometry/arrangement.h"
#include "checker/report.h"

namespace weft::check {

struct FaceRole {
  bool kept = false;
  bool open = false;  // the mesher may choose whether the whole face is meshed
  std::int32_t region = 0;
  bool is_region_open = false;  // sizes of areas differ by no more than their rounding
  double max_area = std::numeric_limits<double>::infinity();
  friend bool operator==(const FaceRole&, const FaceRole&) = default;
};

// One role per face. Fill::kEvenOdd keeps the faces that a path from infinity reaches by crossing
// an odd number of segments; if paths differ (segments that do not close), the one that crosses
// fewest counts. Coincident segments count once each. If there are areas, they decide. A seed on a
// segment is a violation of kDomain, because its face is ambiguous.
//
// If paths differ, the way in which slivers were merged decides which path crosses fewest. Then a
// face is open if two bounds on that number differ: that of paths that enter no sliver, and that of
// paths that cross slivers, each for the one edge, 0 or 1, that the sliver becomes.
// REQUIRES: the arrangement of the bent domain and its links.
std::vector<FaceRole> fill_faces(const BentDomain& bent, const Arrangement& arrangement,
                                 Findings& findings);

}  // namespace weft::check
