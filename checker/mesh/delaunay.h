// SPDX-License-Identifier: Apache-2.0
// The constrained Delaunay property, exactly.
#pragma once

#include "checker/edges/half_edges.h"
#include "checker/edges/listed_edges.h"
#include "checker/mesh.h"
#include "checker/report.h"

namespace weft::check {

// Adds a violation of kDelaunay for each unlisted edge with two triangles of which one has its
// third corner strictly inside the circumcircle of the other. A triangulation without overlap and
// without such edges is the constrained Delaunay triangulation (D. T. Lee and A. K. Lin, 1986).
// REQUIRES: structure, orientation and conformity hold.
void judge_delaunay(const Mesh& mesh, const HalfEdges& half_edges, const ListedEdges& listed,
                    Findings& findings);

}  // namespace weft::check
