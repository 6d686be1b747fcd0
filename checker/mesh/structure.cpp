// SPDX-License-Identifier: Apache-2.0
#include "checker/mesh/structure.h"

#include <array>
#include <cmath>
#include <vector>

#include "checker/domain/domain_rules.h"
#include "checker/edges/half_edges.h"
#include "checker/geometry/predicates.h"
#include "checker/text.h"

namespace weft::check {

bool judge_structure(const Mesh& mesh, Findings& findings) {
  const auto bad = [&](auto&&... parts) {
    findings.add(Rule::kStructure, [&] { return say(parts...); });
  };
  const std::size_t vertices = mesh.vertices.size();
  if (mesh.triangles.empty()) bad("the mesh has no triangle");
  if (mesh.triangles.size() > HalfEdges::kMaxTriangles)
    bad(mesh.triangles.size(), " triangles are more than the ", HalfEdges::kMaxTriangles,
        " that can be judged");
  if (vertices > 0xffffffffu) bad(vertices, " vertices are more than 32 bits can number");
  if (!mesh.regions.empty() && mesh.regions.size() != mesh.triangles.size())
    bad(mesh.regions.size(), " region ids for ", mesh.triangles.size(), " triangles");

  for (std::size_t v = 0; v < vertices; ++v)
    if (const Vec2 p = mesh.vertices[v]; !is_usable(p.x) || !is_usable(p.y))
      bad("vertex ", v, " is at ", p, ": not finite, or of a magnitude beyond 1e-150 to 1e150");

  std::vector<bool> used(vertices, false);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    if (a >= vertices || b >= vertices || c >= vertices) {
      bad("triangle ", t, " has the vertices ", a, ", ", b, ", ", c, ", but there are ", vertices);
      continue;
    }
    if (a == b || b == c || c == a)
      bad("triangle ", t, " has a vertex twice: ", a, ", ", b, ", ", c);
    used[a] = used[b] = used[c] = true;
  }
  for (std::size_t v = 0; v < vertices; ++v)
    if (!used[v]) bad("vertex ", v, " at ", mesh.vertices[v], " belongs to no triangle");
  for (std::size_t i = 0; i < mesh.edges.size(); ++i)
    if (const Mesh::Edge& edge = mesh.edges[i]; edge.a >= vertices || edge.b >= vertices)
      bad("listed edge ", i, " joins vertices ", edge.a, " and ", edge.b, ", but there are ",
          vertices);
  if (!mesh.bulges.empty() && mesh.bulges.size() != mesh.edges.size())
    bad(mesh.bulges.size(), " bulges for ", mesh.edges.size(), " listed edges");
  for (std::size_t i = 0; i < mesh.bulges.size(); ++i)
    if (!(std::fabs(mesh.bulges[i]) <= 1))
      bad("listed edge ", i, " has the bulge ", mesh.bulges[i], ", beyond that of half a circle");
  return findings.total(Rule::kStructure) == 0;
}

bool judge_orientation(const Mesh& mesh, Findings& findings) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::array<std::uint32_t, 3>& v = mesh.triangles[t];
    const Vec2 p = mesh.vertices[v[0]], q = mesh.vertices[v[1]], r = mesh.vertices[v[2]];
    const int turn = orientation(p, q, r);
    if (turn > 0) continue;
    findings.add(Rule::kOrientation, [&] {
      return say("triangle ", t, " (", v[0], ", ", v[1], ", ", v[2], ") at ", p, ", ", q, ", ", r,
                 turn < 0 ? " is clockwise" : " is flat");
    });
  }
  return findings.total(Rule::kOrientation) == 0;
}

}  // namespace weft::check
