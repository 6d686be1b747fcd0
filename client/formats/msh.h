// SPDX-License-Identifier: Apache-2.0
// Gmsh's mesh format 4.1 (https://gmsh.info/doc/texinfo/gmsh.html#MSH-file-format), binary.
//
// Each region is a surface entity with a physical group of dimension 2 named "region <id>", each
// marker a curve entity with one of dimension 1 named "marker <value>". A group's tag is the id or
// value itself where that is positive, otherwise the lowest free number. Vertices on these edges
// belong to a curve, the others to a surface. Vertex i has the tag i + 1.
#pragma once

#include <filesystem>

#include "client/atomic_file.h"
#include "client/error.h"
#include "client/formats/mesh.h"

namespace weft::client {

void write_msh(const MeshView& mesh, OutputFile& file);

// Reads triangles, lines (and points, which are dropped) of a 4.1 file, binary or ASCII. The name
// or else the tag of an entity's first physical group is its region or marker.
Result<Mesh> read_msh(const std::filesystem::path& path);

}  // namespace weft::client
