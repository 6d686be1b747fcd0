// SPDX-License-Identifier: Apache-2.0
// Netgen's mesh, .vol, of two dimensions, which NGSolve reads. Netgen numbers domains and boundary
// conditions from 1 without a gap and finds them by name, so regions and markers have their place
// among all that are there, ascending, and their name, or else "region_<id>" and "marker_<value>".
//
// Triangles have their domain; edges have their boundary condition and the domains on their left
// and on their right, 0 for none. Edges inside the domain are there, too, and those of the boundary
// without a marker count as marker 0. Coordinates have z = 0.
#pragma once

#include <filesystem>

#include "files/base/atomic_file.h"
#include "files/base/error.h"
#include "files/formats/mesh.h"

namespace weft::files {

void write_netgen(const MeshView& mesh, OutputFile& file);

// Names and numbers are those of bcnames and materials: "marker_7" is 7, another name gets the
// smallest positive number that is free; what has no name is its number in the file. Sections of
// other things are passed over; elements that are no triangles of three points are an error.
Result<Mesh> read_netgen(const std::filesystem::path& path);

}  // namespace weft::files
