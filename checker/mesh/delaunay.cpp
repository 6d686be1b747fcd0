// SPDX-License-Identifier: Apache-2.0
#include "checker/mesh/delaunay.h"

#include "checker/geometry/predicates.h"
#include "checker/text.h"

namespace weft::check {

void judge_delaunay(const Mesh& mesh, const HalfEdges& half_edges, const ListedEdges& listed,
                    Findings& findings) {
  for (std::uint32_t h = 0; h < half_edges.size(); ++h) {
    if (!half_edges.has_twin(h) || half_edges.twin(h) < h || listed.listed[h]) continue;
    const std::uint32_t t = h / 3;
    const std::uint32_t twin = half_edges.twin(h);
    const auto [a, b, c] = mesh.triangles[t];
    const std::uint32_t d = mesh.triangles[twin / 3][(twin % 3 + 2) % 3];
    if (in_circle(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], mesh.vertices[d]) <= 0)
      continue;
    findings.add(Rule::kDelaunay, [&] {
      return say("edge (", half_edges.start(h), ", ", half_edges.end(h), "): vertex ", d, " at ",
                 mesh.vertices[d], " of triangle ", twin / 3,
                 " lies inside the circumcircle of triangle ", t);
    });
  }
}

}  // namespace weft::check
