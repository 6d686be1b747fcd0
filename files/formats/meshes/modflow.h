// SPDX-License-Identifier: Apache-2.0
// The input of MODFLOW 6's DISV package: a layer of the Voronoi cells of the vertices
// (voronoi_cells.h). A cell has the number of its vertex, from 1, if every vertex has a triangle.
// The top is the elevation of the bed, or 0, and the bottom is 1 below it.
#pragma once

#include "files/base/atomic_file.h"
#include "files/formats/mesh.h"

namespace weft::files {

void write_disv(const MeshView& mesh, OutputFile& file);

}  // namespace weft::files
