// SPDX-License-Identifier: Apache-2.0
#include "checker/domain/segment_steps.h"

#include <algorithm>
#include <limits>
#include <unordered_map>
#include <utility>

#include "checker/geometry/box_tree.h"

namespace weft::check {
namespace {

constexpr std::size_t kNoStep = std::numeric_limits<std::size_t>::max();

}  // namespace

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
          std::uint32_t goal) {
  std::unordered_map<std::uint32_t, std::size_t>
      reached;  // by vertex: the last step that led there
  const auto by = [&](std::uint32_t vertex) {
    const auto found = reached.find(vertex);
    return found == reached.end() ? kNoStep : found->second;
  };
  std::vector<std::size_t> before(steps.size(), kNoStep);  // the step that led to a step's start
  Walk result{{}, start};
  double farthest = start_position;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const Step& step = steps[k];
    before[k] = by(step.from);
    if (before[k] == kNoStep && step.from != start) continue;
    reached[step.to] = k;
    if (step.to_position > farthest) {
      farthest = step.to_position;
      result.farthest = step.to;
    }
    if (step.to != goal) continue;
    for (std::size_t at = k; at != kNoStep; at = before[at]) result.path.push_back(at);
    break;
  }
  return result;
}

std::optional<std::array<std::uint32_t, 2>> first_joined(std::span<const Step> steps,
                                                         std::span<const std::uint32_t> starts,
                                                         std::span<const std::uint32_t> goals) {
  std::unordered_map<std::uint32_t, std::uint64_t> reached;  // by vertex: from which starts
  for (std::size_t i = 0; i < starts.size(); ++i) reached[starts[i]] |= std::uint64_t{1} << i;
  for (const Step& step : steps)
    if (const auto from = reached.find(step.from); from != reached.end()) {
      const std::uint64_t mask = from->second;  // before `reached` grows
      reached[step.to] |= mask;
    }
  for (std::size_t i = 0; i < starts.size(); ++i)
    for (const std::uint32_t goal : goals)
      if (const auto to = reached.find(goal);
          goal != starts[i] && to != reached.end() && (to->second >> i & 1) != 0)
        return std::array{starts[i], goal};
  return std::nullopt;
}

}  // namespace weft::check
