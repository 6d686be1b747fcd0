// SPDX-License-Identifier: Apache-2.0
// Meshes to write, read and draw: a square [0, n] x [0, n] of n x n unit squares, each cut
// in two triangles. The left half is region 0, the right half region 7; the sides are marked 1 to 4
// from the bottom counter-clockwise.
#pragma once

#include <cstdint>

#include "files/formats/domain.h"
#include "files/formats/mesh.h"

namespace weft::files {

Mesh square_mesh(std::uint32_t n);

// Two triangles, the edge between them, and their boundary but for the right side, which has no
// edge. Some regions and markers have names.
Mesh two_triangles();

// The square's outline: the domain of which square_mesh(n) is a mesh.
Domain square_domain(std::uint32_t n);

}  // namespace weft::files
