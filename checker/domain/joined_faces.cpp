// SPDX-License-Identifier: Apache-2.0
#include "checker/domain/joined_faces.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace weft::check {

JoinedFaces join_faces(const BentDomain& bent, const Arrangement& arrangement,
                       const std::vector<FaceRole>& roles) {
  const std::vector<char> is_sliver = find_slivers(bent, arrangement);
  JoinedFaces result;
  result.of.resize(roles.size());
  std::iota(result.of.begin(), result.of.end(), 0u);
  const auto find = [&](std::uint32_t f) {
    while (result.of[f] != f) f = result.of[f] = result.of[result.of[f]];
    return f;
  };
  for (std::uint32_t e = 0; e < arrangement.edges().size(); ++e) {
    const std::uint32_t left = arrangement.face(2 * e), right = arrangement.face(2 * e + 1);
    if (!arrangement.covers(e).empty() || is_sliver[left] != is_sliver[right]) continue;
    const std::uint32_t f = find(left), g = find(right);
    if (roles[f] == roles[g]) result.of[std::max(f, g)] = std::min(f, g);
  }
  for (std::uint32_t f = 0; f < roles.size(); ++f) result.of[f] = find(f);

  result.faces.resize(roles.size());
  for (std::uint32_t f = 0; f < roles.size(); ++f) {
    result.faces[result.of[f]].area += arrangement.faces()[f].area;
  }
  for (std::uint32_t h = 0; h < 2 * arrangement.edges().size(); ++h) {
    const std::uint32_t face = result.of[arrangement.face(h)];
    if (face == result.of[arrangement.face(h ^ 1u)]) continue;
    const Arrangement::Edge& edge = arrangement.edges()[h / 2];
    const Vec2 p = arrangement.vertices().at(edge.u), q = arrangement.vertices().at(edge.v);
    result.faces[face].perimeter += std::hypot(q.x - p.x, q.y - p.y);
    double& slack = result.faces[face].slack;
    slack = std::max(slack, bent.slack_of(arrangement.covers(h / 2)));
  }
  return result;
}

}  // namespace weft::check
