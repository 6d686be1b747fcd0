// SPDX-License-Identifier: Apache-2.0
// The domain of a mesh whose triangles overlap, such as of two grids that were put into one file.
#pragma once

#include <optional>
#include <string>

#include "files/formats/domain.h"
#include "files/formats/mesh.h"

namespace weft::files {

// What the triangles cover, once (Fill::kUnion), with a warning; nullopt if no two of them overlap,
// which is decided exactly. Triangles of one region that are connected by sides are an area; one
// that overlaps another of its area is an area by itself. Edges of the mesh are lines. Time:
// O(n log n) for n triangles of a size. `name` and REQUIRES: as in mesh_domain.h.
std::optional<Domain> domain_of_overlapping(const std::string& name, const MeshView& mesh);

}  // namespace weft::files
