// SPDX-License-Identifier: Apache-2.0
// SU2's native mesh (https://su2code.github.io/docs_v7/Mesh-File/), two-dimensional: triangles,
// points, and the boundary by marker, whose tag is the number. Every edge of the boundary is in
// one; those without a marker are in 0. Edges inside the domain are left out, because SU2 has none;
// regions are lost.
#pragma once

#include <filesystem>

#include "files/base/atomic_file.h"
#include "files/base/error.h"
#include "files/formats/mesh.h"

namespace weft::files {

void write_su2(const MeshView& mesh, OutputFile& file);

// Triangles and quadrilaterals. The numbers at the ends of the lines of points are obeyed if they
// are those from 0 on in another order; numbers that count up from another one mean nothing, and
// others are an error (kUnreadableInput).
// Tags that are integers are the markers; other tags get the lowest numbers from 1 on that are
// free, in the order of the file.
Result<Mesh> read_su2(const std::filesystem::path& path);

}  // namespace weft::files
