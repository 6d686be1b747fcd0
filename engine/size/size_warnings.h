// SPDX-License-Identifier: Apache-2.0
// Warnings about sizes that are probably not what the client wants.
#pragma once

#include <vector>

#include "weft/geometry.h"
#include "weft/mesh.h"
#include "weft/size.h"

namespace weft {

// At most one of each kind, but one for each field. `box` is that of the domain, `least_bound` the
// least bound on a triangle's area in the mesh, 0 if there is none.
std::vector<SizeWarning> size_warnings(const SizeSpec& size, const Box& box, double least_bound);

}  // namespace weft
