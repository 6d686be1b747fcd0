// SPDX-License-Identifier: Apache-2.0
// Medit's mesh, .mesh, in text and double precision (P. Frey, MEDIT: an interactive mesh
// visualization software, INRIA RT-0253, 2001), as FreeFem++ and mmg2d read it, in the plane. The
// reference of a triangle is its region, that of an edge its marker; those of vertices are 0. Names
// are lost. Edges of the boundary without a marker have the reference 0.
#pragma once

#include <filesystem>

#include "files/base/atomic_file.h"
#include "files/base/error.h"
#include "files/formats/mesh.h"

namespace weft::files {

void write_medit(const MeshView& mesh, OutputFile& file);

// Of files in space z is dropped. Sections of other things, such as corners and required edges, are
// passed over; elements that are no triangles are an error.
Result<Mesh> read_medit(const std::filesystem::path& path);

}  // namespace weft::files
