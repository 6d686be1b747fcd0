// SPDX-License-Identifier: Apache-2.0
// Faces of more than three corners, of meshes that other programs made, cut into triangles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "files/formats/mesh.h"

namespace weft::files {

// The corners of triangles that cover the polygon with these corners, which may be reentrant.
// A corner that repeats the one before it, as in a triangle that is listed as a quadrilateral,
// counts once. A polygon that crosses itself gives triangles, too, which may overlap. O(n^3) for n
// corners. REQUIRES: corners are in range.
std::vector<std::uint32_t> cut_face(std::span<const std::uint32_t> corners,
                                    std::span<const double> coordinates);

// Makes triangles of the faces, after those of the mesh, with their regions and parts. REQUIRES:
// corners are in range.
void cut_faces(Mesh& mesh);

}  // namespace weft::files
