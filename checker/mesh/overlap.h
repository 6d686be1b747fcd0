// SPDX-License-Identifier: Apache-2.0
// No point of the plane is covered twice: an exact proof.
//
// Let L be the edges of the mesh that are listed or have one triangle, and C(p) the number of
// triangles that contain a point p off all edges. All triangles are counter-clockwise and every
// edge has at most one on each side, so C does not change across an edge with two triangles, and
// across an edge of L it changes by (1 if there is a triangle on the left) - (1 if on the right).
// If the edges of L meet only at shared vertices, they divide the plane into faces on which C is
// constant. If, moreover, all edges around a face agree on whether they have a triangle on that
// side (k = 1 or 0), and around the unbounded face none has, then C and k change by the same
// across every edge and agree at infinity: C = k, which is 0 or 1 everywhere.
#pragma once

#include "checker/edges/half_edges.h"
#include "checker/edges/listed_edges.h"
#include "checker/mesh.h"
#include "checker/report.h"

namespace weft::check {

// Adds a violation of kOverlap wherever the proof fails; returns false if there is one.
// REQUIRES: structure, orientation and conformity hold.
bool judge_overlap(const Mesh& mesh, const HalfEdges& half_edges, const ListedEdges& listed,
                   Findings& findings);

}  // namespace weft::check
