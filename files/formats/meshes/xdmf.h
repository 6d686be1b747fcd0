// SPDX-License-Identifier: Apache-2.0
// XDMF 3 (https://www.xdmf.org), as ParaView reads it: a file of XML that says which arrays there
// are, and one of the arrays themselves, little-endian, without gaps. Cells are the triangles, then
// the edges, of mixed topology; attributes of cells are `region`, 0 of edges, `marker`, 0 of
// triangles, and `part`, -1 of edges, if the mesh is divided; of nodes, all values. The grid has an
// element Information for each name: Name="marker 2" Value="inlet".
#pragma once

#include "files/base/atomic_file.h"
#include "files/formats/mesh.h"

namespace weft::files {

// The XML names the file of the arrays by its name alone: both belong in one folder.
void write_xdmf(const MeshView& mesh, OutputFile& xml, OutputFile& arrays);

}  // namespace weft::files
