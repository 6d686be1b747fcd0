// SPDX-License-Identifier: Apache-2.0
// Judges segments that are kept as they are.
#pragma once

#include <cstdint>
#include <vector>

#include "checker/domain/mesh_points.h"
#include "checker/mesh.h"
#include "checker/mesh/chains.h"
#include "checker/report.h"

namespace weft::check {

// Adds a violation of kKept for each vertex between two listed edges of one segment, both with one
// of the markers, of any if there are none, that is neither an input point nor on another listed
// edge. `input_points` are those of the bent domain, which has the vertices of arcs, too. REQUIRES:
// structure holds.
void judge_kept(const Mesh& mesh, const SegmentsOfVertices& segments,
                const InputPoints& input_points, const std::vector<std::int32_t>& markers,
                Findings& findings);

}  // namespace weft::check
