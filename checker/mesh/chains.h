// SPDX-License-Identifier: Apache-2.0
// Compares segments and listed edges. The domain is as the mesh has bent it (bent_domain.h); a
// violation names the segment and the point of the input.
//
// Wherever a segment has a kept face of the arrangement on a side, it must be a chain of listed
// edges, through all input points on it, each edge within the tolerance (tolerance.h) of the
// segment and each step forward along it. Conversely every listed edge must be part of such a
// chain. So a listed edge in a hole or outside is a violation, and so is a gap.
//
// Between slivers (Need::kEitherWay) a chain may be missing, because merging may have led it
// another way. It may not be interrupted there, which skipped_edges.h and chain_ends.h judge. They
// see no interruption between two vertices that other listed edges meet, too, and that the checker
// can join by other edges within the merging distance: of 1,843 meshes of random domains with one
// listed edge removed, 12 are accepted, none of the 455 without `snap`.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "checker/domain/bent_domain.h"
#include "checker/domain/fill.h"
#include "checker/domain/mesh_points.h"
#include "checker/edges/listed_edges.h"
#include "checker/geometry/arrangement.h"
#include "checker/mesh.h"
#include "checker/report.h"

namespace weft::check {

// Which segments of the input, as it was before the mesh bent it, the mesh vertices lie on:
// (vertex, segment), sorted, distinct.
using SegmentsOfVertices = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

// Whether the mesh must have a face: not if it is not kept; if it is a sliver, the mesh may choose
// (joined_faces.h).
enum class Need : std::uint8_t { kNothing, kEitherWay, kAll };

// kPoints: every one of the first `count` points that is in the closure of a needed face (`needs`
// has one entry per face) is a vertex, exactly.
void judge_points(const BentDomain& bent, std::size_t count, const Arrangement& arrangement,
                  const std::vector<Need>& needs, const InputPoints& input_points,
                  Findings& findings);

// Judges kChains, kMarkers, and the listed edges of kEdges that lie on no segment. An input point
// that a chain has lost is left to kPoints. REQUIRES: no overlap.
SegmentsOfVertices judge_chains(const BentDomain& bent, const Arrangement& arrangement,
                                const std::vector<Need>& needs, const Mesh& mesh,
                                const ListedEdges& listed, const InputPoints& input_points,
                                Findings& findings);

}  // namespace weft::check
