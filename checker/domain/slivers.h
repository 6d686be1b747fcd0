// SPDX-License-Identifier: Apache-2.0
// Faces of a bent domain's arrangement that merging, or rounding, may close.
#pragma once

#include <vector>

#include "checker/domain/bent_domain.h"
#include "checker/geometry/arrangement.h"

namespace weft::check {

// The largest area of a sliver, which lies between boundaries that are each uncertain by `slack`.
inline double sliver_area(double perimeter, double slack) {
  return slack * (perimeter + 4 * slack);
}

// Per face, whether it is a sliver by itself. REQUIRES: the arrangement of the bent domain and its
// links.
std::vector<char> find_slivers(const BentDomain& bent, const Arrangement& arrangement);

}  // namespace weft::check
