// SPDX-License-Identifier: Apache-2.0
// Judges sides that repeat each other.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "checker/edges/half_edges.h"
#include "checker/mesh.h"
#include "checker/report.h"

namespace weft::check {

// Adds a violation of kPeriodic for each vertex of a side that the motion between the two sides of
// a pair takes to no vertex of the other, each edge that it takes to no edge, and each pair of
// sides that have not as many edges as each other. The motion takes the mean of the vertices of the
// one side to that of the other, and its edges, in sum, to the opposite of those of the other, the
// mesh at the left of both. Sides are the listed edges with a marker on the boundary; points nearer
// than `tolerance` are the same. REQUIRES: conformity holds.
void judge_periodic(const Mesh& mesh, const HalfEdges& half_edges,
                    const std::vector<std::array<std::int32_t, 2>>& pairs, double tolerance,
                    Findings& findings);

}  // namespace weft::check
