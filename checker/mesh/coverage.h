// SPDX-License-Identifier: Apache-2.0
// The triangles cover the kept faces of the arrangement: all of them, and nothing else.
//
// Triangles connected across unlisted edges form a patch. If there is no overlap (overlap.h) and
// all chains are in place (chains.h), a patch is one face of the arrangement, except for the
// rounding of vertices. Which face is decided exactly, by locating the centre of the patch's
// roundest triangle. The area covered in each face must be that face's, to within
//     1e-12 of it + 4 d (its perimeter + d),  d the tolerance of tolerance.h,
// and a patch in a face that is not kept may have no more area than its own boundary allows by this
// formula. Near bent segments a face is uncertain by the area of a sliver, too, and a patch that is
// no larger than that may have any role and region (joined_faces.h).
#pragma once

#include <cstdint>
#include <vector>

#include "checker/domain/bent_domain.h"
#include "checker/domain/fill.h"
#include "checker/domain/joined_faces.h"
#include "checker/edges/half_edges.h"
#include "checker/edges/listed_edges.h"
#include "checker/geometry/arrangement.h"
#include "checker/mesh.h"
#include "checker/report.h"

namespace weft::check {

// Adds violations of kCoverage and kRegions. Returns the face of each triangle.
// REQUIRES: no overlap.
std::vector<std::uint32_t> judge_coverage(const BentDomain& bent, const Arrangement& arrangement,
                                          const std::vector<FaceRole>& roles,
                                          const JoinedFaces& joined, const Mesh& mesh,
                                          const HalfEdges& half_edges, const ListedEdges& listed,
                                          Findings& findings);

}  // namespace weft::check
