// SPDX-License-Identifier: Apache-2.0
// The exact sign of the area that three points span: J. R. Shewchuk, "Adaptive Precision
// Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997, as a filter with an exact
// fallback. Exact unless products of coordinates overflow or underflow.
#pragma once

#include "files/formats/domain.h"
#include "files/formats/mesh.h"

namespace weft::files {

// 1 if a, b, c turn counter-clockwise, -1 if clockwise, 0 if they are collinear.
int orientation(Point a, Point b, Point c);

// Turns triangles that are clockwise, as some programs number them.
void turn_counter_clockwise(Mesh& mesh);

}  // namespace weft::files
