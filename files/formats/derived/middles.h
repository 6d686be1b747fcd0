// SPDX-License-Identifier: Apache-2.0
// Meshes of second order, as they are read: the nodes in the middle of sides are no vertices.
#pragma once

#include <string>
#include <vector>

#include "files/formats/mesh.h"

namespace weft::files {

// Takes the middles of sides (Mesh::middles) out of the mesh, which is of first order then: an edge
// whose middle is on the bisector of its ends is a chord of an arc, and has its bulge. Other sides
// that bend become straight, with a warning that names the file. Sets Mesh::nodes. Returns what is
// wrong, or "". REQUIRES: vertices of triangles, edges and faces are in range.
std::string take_out_middles(const std::string& file, Mesh& mesh);

// Of the values at the nodes of such a mesh, those at its vertices.
std::vector<double> at_vertices(const Mesh& mesh, std::vector<double> at_nodes);

}  // namespace weft::files
