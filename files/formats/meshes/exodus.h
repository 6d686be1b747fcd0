// SPDX-License-Identifier: Apache-2.0
// Exodus II, as Cubit, MOOSE, SEACAS and ParaView read it, in NetCDF's classic format: an element
// block of TRI3, or TRI6 of second order, for each region, a side set for each marker.
//
//   - The ids of blocks are the regions if all are positive, otherwise 1, 2, ... in their order;
//     the names are those of the regions, or else "region N". The same is true of side sets and
//     markers, "marker N". Rows of names are 33 bytes, as is usual, or as long as the longest
//     needs.
//   - Elements are in the order of the blocks, within one in that of the mesh; `elem_num_map` has
//     the number that a triangle has in other formats, from 1.
//   - An edge inside the domain is a side of the first triangle at it.
//   - Values at nodes and, of elements, `part`, are results of one time step, 0.
#pragma once

#include "files/base/atomic_file.h"
#include "files/formats/mesh.h"

namespace weft::files {

// Throws std::system_error (EOVERFLOW) for 2^31 vertices or triangles.
void write_exodus(const MeshView& mesh, OutputFile& file);

}  // namespace weft::files
