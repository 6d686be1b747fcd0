// SPDX-License-Identifier: Apache-2.0
// Triangle's files beside .node and .ele, numbered from 1 as they are:
//   .edge   every edge of the mesh by its lower vertex, then its higher one, with a marker: that of
//           the segment that it lies on if it is not 0, otherwise 1 on the boundary and 0 inside
//   .neigh  the neighbours of every triangle, opposite its corners 1, 2 and 3; -1 if there is
//           none
#pragma once

#include "files/base/atomic_file.h"
#include "files/formats/mesh.h"

namespace weft::files {

void write_triangle_edges(const MeshView& mesh, OutputFile& file);
void write_triangle_neighbours(const MeshView& mesh, OutputFile& file);

}  // namespace weft::files
