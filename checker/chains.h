// SPDX-License-Identifier: Apache-2.0
// Segments and listed edges against each other.
//
// Wherever a segment has a kept face of the arrangement on a side, it must be a chain of listed
// edges, through all input points on it, each edge within the tolerance (tolerance.h) of the
// segment and each step forward along it. Conversely every listed edge must be part of such a
// chain. So a listed edge in a hole or outside is a violation, and so is a gap.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "checker/arrangement.h"
#include "checker/domain.h"
#include "checker/fill.h"
#include "checker/listed_edges.h"
#include "checker/mesh.h"
#include "checker/mesh_points.h"
#include "checker/report.h"

namespace weft::check {

// Which segments the mesh vertices lie on: (vertex, segment), sorted, distinct.
using SegmentsOfVertices = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

// kPoints: every input point in the closure of a kept face is a vertex, exactly.
void judge_points(const Domain& domain, const Arrangement& arrangement,
                  const std::vector<FaceRole>& roles, const InputPoints& input_points,
                  Findings& findings);

// kChains, kMarkers, and of kEdges: listed edges that lie on no segment. An input point that a
// chain has lost is left to kPoints. REQUIRES: no overlap.
SegmentsOfVertices judge_chains(const Domain& domain, const Arrangement& arrangement,
                                const std::vector<FaceRole>& roles, const Mesh& mesh,
                                const ListedEdges& listed, const InputPoints& input_points,
                                Findings& findings);

}  // namespace weft::check
