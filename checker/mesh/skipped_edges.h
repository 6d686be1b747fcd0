// SPDX-License-Identifier: Apache-2.0
// Finds edges that a mesh should list, on the gaps of a bent domain (bent_domain.h). Merging leads
// the chain of a segment through other vertices, but never interrupts it within the mesh: a chain
// has a gap only where nothing beside it is meshed. So no edge inside the mesh lies on a gap.
#pragma once

#include <cstdint>
#include <vector>

#include "checker/domain.h"
#include "checker/domain/bent_domain.h"
#include "checker/edges/half_edges.h"
#include "checker/edges/listed_edges.h"
#include "checker/mesh.h"
#include "checker/report.h"

namespace weft::check {

struct SkippedEdge {
  std::uint32_t piece;  // a gap
  std::uint32_t a, b;   // mesh vertices
};

// The unlisted edges with triangles on both sides that lie on a gap, to rounding, and run along the
// segment of `domain` that it is a gap of. (Between two chains that the checker cannot join, a gap
// runs across.)
std::vector<SkippedEdge> find_skipped_edges(const Domain& domain, const BentDomain& bent,
                                            const Mesh& mesh, const HalfEdges& half_edges,
                                            const ListedEdges& listed);

// Adds a violation of kChains for each.
void judge_skipped_edges(const std::vector<SkippedEdge>& skipped, const BentDomain& bent,
                         const Mesh& mesh, Findings& findings);

}  // namespace weft::check
