// SPDX-License-Identifier: Apache-2.0
// The open boundary of a sea by its depth: what `--open-boundary deeper:50` opens.
//
// Of the outer rings of the boundary, never of an island, a vertex is deep if its bed (bed.h) is
// deeper than a number of metres, or if both of its neighbours on the ring are: one shallow vertex
// parts no open boundary. Two edges or more in a row between deep vertices are opened; one alone
// stays land, because ADCIRC takes no such piece. The `identify_ocean_boundary_sections` of the
// package oceanmesh opens by depth, too.
//
//   const DeepBoundary deep = deep_boundary(mesh, 50, open_markers);
//   mesh.edges = deep.edges, mesh.edge_markers = deep.markers;  // deep.marker is that of open ones
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "files/formats/mesh.h"

namespace weft::files {

struct DeepBoundary {
  // The mesh's edges, then those that were opened, which may be among them: the last one counts.
  std::vector<std::uint32_t> edges;
  std::vector<std::int32_t> markers;
  std::int32_t marker = 1;  // of the opened: the least from 1 that the mesh's edges do not have
  std::size_t opened = 0;
};

// Edges with one of `open_markers` are open by that, and keep it; `marker` is none of these.
// REQUIRES: the mesh's bed is known; see boundary_rings (mesh_edges.h) for its triangles.
DeepBoundary deep_boundary(const MeshView& mesh, double deeper,
                           std::span<const std::int32_t> open_markers);

}  // namespace weft::files
