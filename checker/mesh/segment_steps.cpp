// SPDX-License-Identifier: Apache-2.0
#include "checker/mesh/segment_steps.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "checker/geometry/box_tree.h"

namespace weft::check {

Track track_of(const Domain& domain, std::uint32_t segment) {
  Vec2 from = domain.points[domain.segments[segment][0]];
  Vec2 to = domain.points[domain.segments[segment][1]];
  if (lexicographically_less(to, from)) std::swap(from, to);
  return {from, to};
}

std::vector<Step> steps_along_segments(const Domain& domain, const Mesh& mesh,
                                       const ListedEdges& listed,
                                       std::span<const double> tolerances) {
  std::vector<Box> boxes;
  boxes.reserve(domain.segments.size());
  for (std::size_t s = 0; s < domain.segments.size(); ++s) {
    const auto [a, b] = domain.segments[s];
    boxes.push_back(box_of(domain.points[a], domain.points[b]).grown(2 * tolerances[s]));
  }
  const BoxTree tree(std::move(boxes));
  std::vector<Step> steps;
  for (std::uint32_t i = 0; i < mesh.edges.size(); ++i) {
    if (!listed.half_edge[i]) continue;
    const std::uint32_t a = mesh.edges[i].a, b = mesh.edges[i].b;
    const Vec2 p = mesh.vertices[a], q = mesh.vertices[b];
    tree.visit(box_of(p, p), [&](std::uint32_t s) {
      const Track track = track_of(domain, s);
      if (!track.carries(p, tolerances[s]) || !track.carries(q, tolerances[s])) return;
      const double at_p = track.position(p), at_q = track.position(q);
      if (at_p < at_q)
        steps.push_back({s, at_p, at_q, a, b, i});
      else
        steps.push_back({s, at_q, at_p, b, a, i});
    });
  }
  std::sort(steps.begin(), steps.end(),
            [](const Step& l, const Step& r) { return l.key() < r.key(); });
  return steps;
}

Walk walk(std::span<const Step> steps, std::uint32_t start, double start_position,
          std::uint32_t goal, double slack) {
  struct Reached {
    std::uint32_t vertex;
    double position;
    std::optional<std::size_t> by;  // step
  };
  std::vector<Reached> trail = {{start, start_position, std::nullopt}};  // everything reached
  std::vector<std::size_t> ahead = {0};  // of the trail, what later steps may start from
  std::vector<std::size_t> predecessor(steps.size(), 0);  // where in the trail a step starts
  std::size_t farthest = 0;                               // in the trail
  Walk result{{}, start};
  for (std::size_t k = 0; k < steps.size() && result.path.empty(); ++k) {
    const Step& step = steps[k];
    std::erase_if(ahead,
                  [&](std::size_t r) { return trail[r].position < step.from_position - slack; });
    const auto found = std::find_if(ahead.rbegin(), ahead.rend(),
                                    [&](std::size_t r) { return trail[r].vertex == step.from; });
    if (found == ahead.rend()) continue;
    predecessor[k] = *found;
    ahead.push_back(trail.size());
    if (step.to_position > trail[farthest].position) farthest = trail.size();
    trail.push_back({step.to, step.to_position, k});
    if (step.to != goal) continue;
    for (Reached at = trail.back(); at.by; at = trail[predecessor[*at.by]])
      result.path.push_back(*at.by);
  }
  result.farthest = trail[farthest].vertex;
  return result;
}

}  // namespace weft::check
