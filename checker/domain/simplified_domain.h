// SPDX-License-Identifier: Apache-2.0
// The domain that a mesh of a simplified domain has, taken from the mesh itself: what
// simplification has done cannot be known from the original. The mesh is then judged against this
// domain as against any other, and this domain against the original (mesh/simplification.h).
//
// Its segments are the listed edges of the mesh, joined where they run straight on: at a vertex of
// two listed edges with one marker that is no point of the original and lies on the line between
// its neighbours, to rounding. The meshed area is that inside the mesh's own boundary, and what
// listed edges divide has the region of its first triangle.
#pragma once

#include <vector>

#include "checker/domain.h"
#include "checker/edges/half_edges.h"
#include "checker/mesh.h"

namespace weft::check {

struct SimplifiedDomain {
  Domain domain;
  Mesh mesh;  // with input points numbered as in `domain`
};

// REQUIRES: the mesh's structure and conformity hold, and those of `original`.
SimplifiedDomain simplified_domain(const Domain& original, const Mesh& mesh,
                                   const HalfEdges& half_edges);

}  // namespace weft::check
