// SPDX-License-Identifier: Apache-2.0
// SMS's mesh file, .2dm (https://www.xmswiki.com/wiki/SMS:2D_Mesh_Files_*.2dm), as SMS, QGIS and
// BASEMENT read it: E3T lines, triangles with their region as the material; ND lines, vertices with
// the elevation of the bed (bed.h), or 0; NS lines, node strings along the boundary, cut
// where the marker changes, each with its marker behind the last node, which is negative. A ring
// of one marker repeats its first node. Markers of edges inside are lost.
//
// Names are in quotation marks: a marker's behind its number in the NS line, a region's in a MAT
// line between BEG2DMBC and END2DMBC, as SMS has that of a material.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "files/base/atomic_file.h"
#include "files/base/error.h"
#include "files/formats/derived/vertex_values.h"
#include "files/formats/mesh.h"

namespace weft::files {

void write_2dm(const MeshView& mesh, OutputFile& file);

// Reads these cards of a file; E4Q lines, quadrilaterals, too; others are passed over, but for
// elements of other kinds.
Result<Mesh> read_2dm(const std::filesystem::path& path);

// The same with the third coordinate, as the array "elevation".
Result<MeshWithArrays> read_2dm_values(const std::filesystem::path& path,
                                       const std::optional<std::string>& wanted);

}  // namespace weft::files
