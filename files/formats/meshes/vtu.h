// SPDX-License-Identifier: Apache-2.0
// VTK's unstructured grid, XML with raw appended data (VTK file formats, "XML file formats"):
// points in 3D with z = 0; the triangles, then the edges on input segments as line cells; cell data
// `region` (0 on lines), `marker` (0 on triangles) and, if the mesh is divided, `part` (-1 on
// lines), all Int32; values at nodes as point data of their names. Of second order: quadratic
// triangles and quadratic edges.
//
// Names of markers and regions are field data, as meshio has Gmsh's physical names there: an Int32
// array for each name, which holds the id and the dimension: 1 for a marker, 2 for a region.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "files/base/atomic_file.h"
#include "files/base/error.h"
#include "files/formats/derived/vertex_values.h"
#include "files/formats/mesh.h"

namespace weft::files {

void write_vtu(const MeshView& mesh, OutputFile& file);

// Reads files of write_vtu, and other programs' grids of triangles, lines and vertices if they are
// little-endian, uncompressed, and raw appended or ASCII.
Result<Mesh> read_vtu(const std::filesystem::path& path);

// The same with an array of its point data, of one component.
Result<MeshWithArrays> read_vtu_values(const std::filesystem::path& path,
                                       const std::optional<std::string>& wanted);

}  // namespace weft::files
