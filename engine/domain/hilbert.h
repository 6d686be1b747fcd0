// SPDX-License-Identifier: GPL-3.0-or-later
// The order of points along a Hilbert curve: neighbours in the order are neighbours in the plane.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/domain/pacer.h"
#include "engine/geometry.h"

namespace weft {

// A permutation of 0 .. points.size() - 1. Points in one cell of the 2^24 x 2^24 grid over their
// bounding box keep their order. REQUIRES: finite coordinates. Throws Stopped.
std::vector<std::uint32_t> hilbert_order(const std::vector<Point>& points, Pacer& pacer);

}  // namespace weft
