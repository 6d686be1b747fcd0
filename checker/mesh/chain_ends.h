// SPDX-License-Identifier: Apache-2.0
// Judges where chains of listed edges end. Merging leads chains through other vertices, but gives
// none an end: a vertex with a single listed edge is the end of a segment, or a point that the end
// may have moved to. (A chain that leaves the mesh ends on the boundary, which is listed, too.)
#pragma once

#include "checker/domain.h"
#include "checker/domain/near_features.h"
#include "checker/edges/listed_edges.h"
#include "checker/mesh.h"
#include "checker/report.h"

namespace weft::check {

// Adds a violation of kChains for each other end. REQUIRES: structure and conformity hold.
void judge_chain_ends(const Domain& domain, const NearFeatures& near, const Mesh& mesh,
                      const ListedEdges& listed, Findings& findings);

}  // namespace weft::check
