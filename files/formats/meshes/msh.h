// SPDX-License-Identifier: Apache-2.0
// Gmsh's mesh formats 4.1, written binary, and 2.2, which older programs read, written as text
// (https://gmsh.info/doc/texinfo/gmsh.html#MSH-file-format).
//
// Each region is a surface entity, each marker a curve entity, with a physical group
// (msh_groups.h). In 4.1, vertices on edges belong to a curve, the others to a surface. Vertex i
// has the tag i + 1. $Periodic has sides that repeat each other: the second of a pair, then the
// first, its master.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "files/base/atomic_file.h"
#include "files/base/error.h"
#include "files/formats/derived/periodic_nodes.h"
#include "files/formats/derived/vertex_values.h"
#include "files/formats/mesh.h"

namespace weft::files {

void write_msh(const MeshView& mesh, std::span<const PeriodicNodes> periodic, OutputFile& file);
void write_msh22(const MeshView& mesh, std::span<const PeriodicNodes> periodic, OutputFile& file);

// Reads triangles, lines (and points, which are dropped) of a 4.1 or 2.2 file, binary or ASCII. The
// tag of an element's first physical group is its region or marker, and the group's name is the
// region's or the marker's, unless that name is "region <id>" or "marker <value>", which is the
// region or the marker itself.
Result<Mesh> read_msh(const std::filesystem::path& path);

// The same with the $NodeData of that name, of one component; if it has several, as of several
// steps of time, the last. A vertex that it does not list has the value NaN.
Result<MeshWithArrays> read_msh_values(const std::filesystem::path& path,
                                       const std::optional<std::string>& wanted);

}  // namespace weft::files
