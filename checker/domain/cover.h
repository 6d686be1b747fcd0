// SPDX-License-Identifier: Apache-2.0
// Which areas cover each face of the arrangement.
#pragma once

#include <cstdint>
#include <vector>

#include "checker/domain/bent_domain.h"
#include "checker/geometry/arrangement.h"

namespace weft::check {

// Per face the numbers of its areas, ascending. A step across an edge leaves or enters every area
// with an odd number of segments on it. REQUIRES: the borders of areas are closed.
std::vector<std::vector<std::uint32_t>> covering_areas(const BentDomain& bent,
                                                       const Arrangement& arrangement);

}  // namespace weft::check
