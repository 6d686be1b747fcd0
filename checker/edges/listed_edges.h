// SPDX-License-Identifier: Apache-2.0
// The edges that a mesh lists as lying on segments, found among its triangles.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "checker/edges/half_edges.h"
#include "checker/mesh.h"
#include "checker/report.h"

namespace weft::check {

struct ListedEdges {
  // Per listed edge: one of its half-edges; nullopt if the triangles do not have the edge, or if it
  // was listed before.
  std::vector<std::optional<std::uint32_t>> half_edge;
  std::vector<bool> listed;  // per half-edge, both directions
};

// Adds violations of kEdges: a listed edge that is not an edge of the mesh, one listed twice, a
// boundary edge that is not listed. REQUIRES: structure and conformity hold.
ListedEdges find_listed_edges(const Mesh& mesh, const HalfEdges& half_edges, Findings& findings);

}  // namespace weft::check
