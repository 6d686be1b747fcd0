// SPDX-License-Identifier: Apache-2.0
// Triangle's mesh files (https://www.cs.cmu.edu/~quake/triangle.html), numbered from 1:
//   .node  vertices with a marker: that of the input point if it is not 0, otherwise the first
//          marker that is not 0 of the vertex's edges in the .poly file, otherwise 1 if there
//          are such edges, otherwise 0
//   .ele   triangles with their region id as the one attribute
//   .poly  the edges on input segments with their markers; no points of its own, no holes
// For order 2, .ele has six nodes: the corners, then the middle of the side opposite each.
#pragma once

#include <filesystem>

#include "files/base/atomic_file.h"
#include "files/base/error.h"
#include "files/formats/mesh.h"

namespace weft::files {

void write_triangle_mesh(const MeshView& mesh, OutputFile& node, OutputFile& ele, OutputFile& poly);

// Reads .node and .ele, and .poly if there is one. `path` names the .node or the .ele file.
Result<Mesh> read_triangle_mesh(const std::filesystem::path& path);

}  // namespace weft::files
