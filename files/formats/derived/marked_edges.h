// SPDX-License-Identifier: Apache-2.0
// The edges of a mesh for solvers, which want a condition on all of its boundary: the mesh's own
// edges in their order, then the boundary's other edges, which have no marker, with 0, in the order
// of MeshEdges.
//
//   const MarkedEdges marked(mesh, edges);
//   for (const std::size_t i : mesh.up_to(marked.size()))
//     ... marked.ends(i), marked.marker(i) ...
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "files/formats/derived/mesh_edges.h"
#include "files/formats/mesh.h"

namespace weft::files {

class MarkedEdges {
 public:
  // `mesh` and `edges`, which are those of the mesh, outlive this.
  MarkedEdges(const MeshView& mesh, const MeshEdges& edges);

  std::size_t size() const { return mesh_.edge_count() + others_.size(); }
  // Its number in `edges`.
  std::size_t edge(std::size_t i) const {
    return is_own(i) ? edges_.of_input_edge(i) : others_[i - mesh_.edge_count()];
  }
  // Of the mesh's own edges as the mesh has them, of others the lower vertex first.
  std::array<std::uint32_t, 2> ends(std::size_t i) const {
    if (is_own(i)) return {mesh_.edges[2 * i], mesh_.edges[2 * i + 1]};
    return {edges_.low(edge(i)), edges_.high(edge(i))};
  }
  std::int32_t marker(std::size_t i) const { return is_own(i) ? mesh_.edge_markers[i] : 0; }
  // The markers of all of them.
  ScratchArray<std::int32_t> markers() const;

 private:
  bool is_own(std::size_t i) const { return i < mesh_.edge_count(); }

  const MeshView& mesh_;
  const MeshEdges& edges_;
  std::vector<std::uint32_t> others_;
};

}  // namespace weft::files
