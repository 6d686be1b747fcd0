// SPDX-License-Identifier: Apache-2.0
// Makes the domain of a mesh, to mesh it anew.
//
// Segments are the mesh's own edges (a Gmsh file's lines), the boundary of its triangles, and the
// sides between triangles of different regions; those without a marker have 0. Points are the ends
// of segments. If there are triangles, the area that they cover is filled (Fill::kEvenOdd; segments
// inside are listed twice, which does not change the parity), and each part between segments whose
// region is not 0 gets a seed. Without triangles every bounded face is filled (Fill::kSeeds).
//
// A triangle that has the corners of one before it, in any order, is left out with a warning:
// some programs write one that is in two groups twice. If triangles overlap, all that they cover is
// filled (overlapping_mesh.h).
#pragma once

#include <string>

#include "files/formats/domain.h"
#include "files/formats/mesh.h"

namespace weft::files {

// `name` is that of the mesh, for the places of points and segments. REQUIRES: vertex numbers are
// in range.
Domain domain_of_mesh(const std::string& name, const MeshView& mesh);

}  // namespace weft::files
