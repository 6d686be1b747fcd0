// SPDX-License-Identifier: Apache-2.0
// Judges how a mesh of a simplified domain is connected, against the original domain.
#pragma once

#include "checker/edges/half_edges.h"
#include "checker/mesh.h"
#include "checker/mesh/simplification.h"
#include "checker/report.h"

namespace weft::check {

// Adds violations of kSimplified:
//   - two parts of the mesh, each connected across edges, lie in one part of the original. The
//     middles of a part's triangles tell where it lies, unless they lie in several. Not judged if
//     the domain has a snap distance, because that may divide a part, too;
//   - the boundary passes a vertex twice or more often, and within what merging explains of
//     it no segments of the original meet, but for two that follow each other.
// REQUIRES: the mesh's conformity.
void judge_parts(const FacedDomain& original, const Mesh& mesh, const HalfEdges& half_edges,
                 Findings& findings);

}  // namespace weft::check
