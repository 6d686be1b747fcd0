// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/marked_edges.h"

namespace weft::files {

MarkedEdges::MarkedEdges(const MeshView& mesh, const MeshEdges& edges)
    : mesh_(mesh), edges_(edges) {
  ScratchArray<std::uint8_t> is_own(mesh.pages, edges.size());
  for (const std::size_t i : mesh.up_to(mesh.edge_count())) is_own[edges.of_input_edge(i)] = 1;
  for (const std::size_t e : mesh.up_to(edges.size()))
    if (edges.on_boundary(e) && is_own[e] == 0) others_.push_back(static_cast<std::uint32_t>(e));
}

ScratchArray<std::int32_t> MarkedEdges::markers() const {
  ScratchArray<std::int32_t> markers(mesh_.pages, size());
  for (const std::size_t i : mesh_.up_to(size())) markers[i] = marker(i);
  return markers;
}

}  // namespace weft::files
