// SPDX-License-Identifier: Apache-2.0
// VTK's unstructured grid, XML with raw appended data (VTK file formats, "XML file formats"):
// points in 3D with z = 0; the triangles, then the edges on input segments as line cells; cell data
// `region` (0 on lines) and `marker` (0 on triangles), both Int32. Of second order: quadratic
// triangles and quadratic edges.
#pragma once

#include <filesystem>
#include <string>

#include "client/base/atomic_file.h"
#include "client/base/error.h"
#include "client/formats/mesh.h"
#include "client/formats/vertex_values.h"

namespace weft::client {

void write_vtu(const MeshView& mesh, OutputFile& file);

// Reads files of write_vtu, and other programs' grids of triangles, lines and vertices if they are
// little-endian, uncompressed, and raw appended or ASCII.
Result<Mesh> read_vtu(const std::filesystem::path& path);

// The same with an array of its point data, of one component.
Result<VertexValues> read_vtu_values(const std::filesystem::path& path, const std::string& array);

}  // namespace weft::client
