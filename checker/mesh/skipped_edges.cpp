// SPDX-License-Identifier: Apache-2.0
#include "checker/mesh/skipped_edges.h"

#include <cmath>
#include <utility>

#include "checker/domain/segment_steps.h"
#include "checker/domain/tolerance.h"
#include "checker/geometry/box_tree.h"
#include "checker/text.h"

namespace weft::check {

std::vector<SkippedEdge> find_skipped_edges(const Domain& domain, const BentDomain& bent,
                                            const Mesh& mesh, const HalfEdges& half_edges,
                                            const ListedEdges& listed) {
  std::vector<SkippedEdge> skipped;
  std::vector<std::uint32_t> gaps;
  std::vector<Box> boxes;
  for (std::uint32_t piece = 0; piece < bent.domain.segments.size(); ++piece) {
    if (!bent.is_gap[piece]) continue;
    const auto [a, b] = bent.domain.segments[piece];
    gaps.push_back(piece);
    boxes.push_back(box_of(bent.domain.points[a], bent.domain.points[b]).grown(2 * bent.rounding));
  }
  if (gaps.empty()) return skipped;
  // Of its length, how much of an edge runs along its segment.
  constexpr double kAlong = 0.9;
  const BoxTree tree(std::move(boxes));
  for (std::uint32_t h = 0; h < half_edges.size(); ++h) {
    if (listed.listed[h] || !half_edges.has_twin(h) || half_edges.twin(h) < h) continue;
    const std::uint32_t a = half_edges.start(h), b = half_edges.end(h);
    const Vec2 p = mesh.vertices[a], q = mesh.vertices[b];
    tree.visit(box_of(p, p), [&](std::uint32_t gap) {
      const std::uint32_t piece = gaps[gap];
      const Track on = track_of(bent.domain, piece);
      if (!on.carries(p, bent.rounding) || !on.carries(q, bent.rounding)) return;
      const Track along = track_of(domain, bent.origin[piece]);
      if (std::fabs(along.position(p) - along.position(q)) >=
          kAlong * std::hypot(p.x - q.x, p.y - q.y))
        skipped.push_back({piece, a, b});
    });
  }
  return skipped;
}

void judge_skipped_edges(const std::vector<SkippedEdge>& skipped, const BentDomain& bent,
                         const Mesh& mesh, Findings& findings) {
  for (const SkippedEdge& edge : skipped)
    findings.add(Rule::kChains, [&] {
      return say("segment ", bent.given[edge.piece], ": the edge (", edge.a, ", ", edge.b,
                 ") from ", mesh.vertices[edge.a], " to ", mesh.vertices[edge.b],
                 " of its chain is not listed");
    });
}

}  // namespace weft::check
