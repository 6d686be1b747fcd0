// SPDX-License-Identifier: Apache-2.0
#include "checker/edges/listed_edges.h"

#include "checker/text.h"

namespace weft::check {

ListedEdges find_listed_edges(const Mesh& mesh, const HalfEdges& half_edges, Findings& findings) {
  ListedEdges result{std::vector<std::optional<std::uint32_t>>(mesh.edges.size()),
                     std::vector<bool>(half_edges.size(), false)};
  for (std::size_t i = 0; i < mesh.edges.size(); ++i) {
    const Mesh::Edge& edge = mesh.edges[i];
    const std::optional<std::uint32_t> h = half_edges.find(edge.a, edge.b);
    if (!h || result.listed[*h]) {
      findings.add(Rule::kEdges, [&] {
        return say("listed edge ", i, " (", edge.a, ", ", edge.b, ") from ", mesh.vertices[edge.a],
                   " to ", mesh.vertices[edge.b],
                   h ? " is listed twice" : " is not an edge of the mesh");
      });
      continue;
    }
    result.half_edge[i] = h;
    result.listed[*h] = true;
    if (half_edges.has_twin(*h)) result.listed[half_edges.twin(*h)] = true;
  }
  for (std::uint32_t h = 0; h < half_edges.size(); ++h) {
    if (half_edges.has_twin(h) || result.listed[h]) continue;
    findings.add(Rule::kEdges, [&] {
      const std::uint32_t a = half_edges.start(h);
      const std::uint32_t b = half_edges.end(h);
      return say("edge (", a, ", ", b, ") from ", mesh.vertices[a], " to ", mesh.vertices[b],
                 " of triangle ", h / 3, " is on the boundary, but not listed");
    });
  }
  return result;
}

}  // namespace weft::check
