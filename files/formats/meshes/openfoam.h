// SPDX-License-Identifier: Apache-2.0
// A mesh of OpenFOAM that is one cell thick: prisms over the triangles, from z = 0 to the square
// root of their mean area. A patch for each marker on the boundary, by its name or else "marker_N",
// "frontAndBack" of type empty, a cell zone for each region, by its name or else "region_N". Text,
// in the folder constant/polyMesh beside an empty file .foam, which ParaView opens.
//
// Cells have the order of the triangles; points that of the vertices, those at z = 0 first.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "files/base/atomic_file.h"
#include "files/formats/mesh.h"

namespace weft::files {

// case.foam, constant/polyMesh/points, faces, owner, neighbour, boundary, cellZones.
std::vector<std::filesystem::path> openfoam_files(const std::filesystem::path& path);

// REQUIRES: the files are those of openfoam_files.
void write_openfoam(const MeshView& mesh, std::span<OutputFile> files);

}  // namespace weft::files
