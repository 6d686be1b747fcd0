// SPDX-License-Identifier: Apache-2.0
// Which faces of the arrangement are meshed, and in which region each lies.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "checker/arrangement.h"
#include "checker/domain.h"
#include "checker/report.h"

namespace weft::check {

struct FaceRole {
  bool kept = false;
  std::int32_t region = 0;
  double max_area = std::numeric_limits<double>::infinity();
  friend bool operator==(const FaceRole&, const FaceRole&) = default;
};

// One role per face. Fill::kEvenOdd keeps the faces that a path from infinity reaches by crossing
// an odd number of segments; where paths differ (segments that do not close) the one that crosses
// fewest counts. Coincident segments count once each. A seed on a segment is a violation of
// kDomain: its face is ambiguous.
std::vector<FaceRole> fill_faces(const Domain& domain, const Arrangement& arrangement,
                                 Findings& findings);

}  // namespace weft::check
