// SPDX-License-Identifier: Apache-2.0
// SELAFIN (Serafin), the geometry file of TELEMAC (TELEMAC's user manual, "The SELAFIN format"):
// one time step, in double precision, big-endian records of Fortran. Variables are BOTTOM, the
// elevation of the bed (bed.h), or 0, in metres, and the other values at nodes by their names. The
// boundary is numbered, the rings around the outside counter-clockwise, then those around islands
// clockwise. Markers and regions are lost.
//
// A record has less than 2 GiB: more than 178,956,969 triangles are a failure of the file (EFBIG).
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "files/base/atomic_file.h"
#include "files/base/error.h"
#include "files/formats/derived/vertex_values.h"
#include "files/formats/mesh.h"

namespace weft::files {

void write_selafin(const MeshView& mesh, OutputFile& file);

// Reads files of either precision and byte order, of one plane; triangles or quadrilaterals.
// Coordinates include the file's offset. It has no edges.
Result<Mesh> read_selafin(const std::filesystem::path& path);

// The same with its variables at the last time step, by their names; BOTTOM, or FOND in French, is
// the array "elevation".
Result<MeshWithArrays> read_selafin_values(const std::filesystem::path& path,
                                           const std::optional<std::string>& wanted);

}  // namespace weft::files
