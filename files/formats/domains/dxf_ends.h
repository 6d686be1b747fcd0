// SPDX-License-Identifier: Apache-2.0
// Joins what a drawing draws as joined. The end of an arc is computed from its centre, its radius
// and an angle, so it misses the end of the line that goes on from it by the rounding of these.
#pragma once

#include <vector>

#include "files/formats/domains/dxf_shapes.h"

namespace weft::files {

// Moves the computed ends of lines that are not closed to the nearest position of the file, or of
// an end that was computed before, within 1e-9 of the extent of the drawing and 1e-3 of the
// distance between the line's ends. O(n) for n positions.
void join_ends(std::vector<DxfShape>& shapes);

// Sets bulges to 0 that are beyond 1e6 or between two positions nearer than 1e-12 of the extent of
// the drawing. Returns which shapes had one.
std::vector<bool> straighten_degenerate(std::vector<DxfShape>& shapes);

}  // namespace weft::files
