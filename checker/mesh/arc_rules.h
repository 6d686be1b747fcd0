// SPDX-License-Identifier: Apache-2.0
// The chains of arcs (domain/arc_chains.h), by themselves. All violations are of kChains.
#pragma once

#include <vector>

#include "checker/domain/arc_chains.h"
#include "checker/domain/bent_domain.h"
#include "checker/edges/listed_edges.h"
#include "checker/geometry/arrangement.h"
#include "checker/mesh.h"
#include "checker/mesh/chains.h"
#include "checker/report.h"

namespace weft::check {

inline constexpr double kMaxTurn = 60;  // degrees, of an edge

// Each edge of a chain turns by `max_turn` degrees at most. In its hull, between it and the
// tangents in its ends, which holds the arc itself, there is no vertex, no other listed edge and no
// other hull, but for common ends. So where others cross an arc, they do so in a vertex, and the
// chains lie to each other as the arcs do. Where arcs and segments touch (tangent_curves.h), this
// holds of vertices alone, and up to the arc.
void judge_arc_chords(const ArcChains& chains, const Mesh& mesh, const ListedEdges& listed,
                      double max_turn, Findings& findings);

// The arc that each edge is said to be a chord of, if the mesh says it, passes the middle of the
// part of the domain's arc that lies between the edge's ends. All other edges are said to be
// straight.
void judge_arc_bulges(const ArcChains& chains, const Mesh& mesh, const ListedEdges& listed,
                      Findings& findings);

// No segment, and no gap of an arc, that the mesh lacks comes between an edge of a chain and its
// arc: it would cross the arc in a vertex. `bent`: the straight domain of the chains, bent, with
// its arrangement and what is needed of its faces.
void judge_arc_crossings(const ArcChains& chains, const BentDomain& bent,
                         const Arrangement& arrangement, const std::vector<Need>& needs,
                         const Mesh& mesh, Findings& findings);

// No gap lies beside a face that is needed.
void judge_arc_gaps(const ArcChains& chains, const BentDomain& bent, const Arrangement& arrangement,
                    const std::vector<Need>& needs, const Mesh& mesh, const ListedEdges& listed,
                    Findings& findings);

}  // namespace weft::check
