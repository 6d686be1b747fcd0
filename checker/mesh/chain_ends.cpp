// SPDX-License-Identifier: Apache-2.0
#include "checker/mesh/chain_ends.h"

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "checker/domain/tolerance.h"
#include "checker/geometry/box_tree.h"
#include "checker/text.h"

namespace weft::check {

void judge_chain_ends(const Domain& domain, const NearFeatures& near, const Mesh& mesh,
                      const ListedEdges& listed, Findings& findings) {
  std::vector<std::uint32_t> degree(mesh.vertices.size(), 0);
  for (std::size_t i = 0; i < mesh.edges.size(); ++i) {
    if (!listed.half_edge[i]) continue;
    ++degree[mesh.edges[i].a];
    ++degree[mesh.edges[i].b];
  }
  std::vector<std::uint32_t> ends;  // points of the domain
  std::vector<Box> boxes;
  const auto reach = [&](std::uint32_t point) {
    return near.may_move[point] ? near.merging_distance * (1 + kMergingSlack) : 0;
  };
  for (const SegmentEnds& segment : domain.segments) {
    for (const std::uint32_t point : segment) {
      const Vec2 p = domain.points[point];
      ends.push_back(point);
      boxes.push_back(box_of(p, p).grown(reach(point)));
    }
  }
  const BoxTree tree(std::move(boxes));
  for (std::uint32_t v = 0; v < degree.size(); ++v) {
    if (degree[v] != 1) continue;
    const Vec2 p = mesh.vertices[v];
    bool is_end = false;
    tree.visit(box_of(p, p), [&](std::uint32_t k) {
      const Vec2 q = domain.points[ends[k]];
      is_end = is_end || std::hypot(p.x - q.x, p.y - q.y) <= reach(ends[k]);
    });
    if (!is_end)
      findings.add(Rule::kChains, [&] {
        return say("a chain of listed edges ends at vertex ", v, " at ", p,
                   ", which is no end of a segment");
      });
  }
}

}  // namespace weft::check
