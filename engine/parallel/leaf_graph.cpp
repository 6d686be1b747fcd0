// SPDX-License-Identifier: Apache-2.0
#include "engine/parallel/leaf_graph.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace weft {

namespace {

// In a phase, the tasks of later leaves wait for those of earlier ones.
std::vector<std::uint32_t> along_order(const LeafOrder& order, LeafOrder::Phase phase,
                                       std::vector<std::uint32_t> first) {
  const std::vector<std::uint32_t> all = order.all(phase);
  std::for_each(all.rbegin(), all.rend(), [&](std::uint32_t l) {
    for (const std::uint32_t other : order.overlapping(l)) {
      if (order.before(l, other, phase)) first[l] = std::min(first[l], first[other]);
    }
  });
  return first;
}

// Per leaf: the first fragment that it, or a leaf that overlaps it, is needed for.
std::vector<std::uint32_t> first_around(const LeafOrder& order,
                                        const std::vector<std::uint32_t>& needs) {
  std::vector<std::uint32_t> first = needs;
  for (std::uint32_t l = 0; l < order.size(); ++l) {
    for (const std::uint32_t other : order.overlapping(l))
      first[l] = std::min(first[l], needs[other]);
  }
  return first;
}

}  // namespace

void LeafGraph::add_refinement(const LeafOrder& order, TaskGraph& graph) {
  for (std::uint32_t l = 0; l < order.size(); ++l) {
    for (std::uint32_t r = 0; r < kRounds; ++r) {
      const bool after_check = r == kMigrationRounds;
      if (r > 0)
        graph.add_dependency(after_check ? check_pending(l) : round(l, r - 1), round(l, r));
      for (const std::uint32_t other : order.overlapping(l)) {
        if (order.before(other, l, LeafOrder::phase_of(r))) {
          graph.add_dependency(round(other, r), round(l, r));
        } else if (r > 0 && !after_check) {
          graph.add_dependency(round(other, r - 1), round(l, r));
        }
      }
    }
    graph.add_dependency(round(l, kMigrationRounds - 1), check_pending(l));
    for (const std::uint32_t other : order.overlapping(l))
      graph.add_dependency(round(other, kMigrationRounds - 1), check_pending(l));
  }
}

void LeafGraph::add_emission(const LeafOrder& order, TaskGraph& graph, bool smooths) {
  for (std::uint32_t l = 0; l < order.size(); ++l) {
    graph.add_dependency(round(l, kRounds - 1), check_settled(l));
    graph.add_dependency(check_settled(l), smooth(l));
    graph.add_dependency(check_settled(l), number_vertices(l));
    if (l > 0) graph.add_dependency(number_vertices(l - 1), number_vertices(l));
    graph.add_dependency(number_vertices(l), export_triangles(l));
    graph.add_dependency(export_triangles(l), emit(l));
    graph.add_dependency(smooth(l), emit(l));
    for (const std::uint32_t other : order.overlapping(l)) {
      graph.add_dependency(round(other, kRounds - 1), check_settled(l));
      graph.add_dependency(check_settled(other), number_vertices(l));
      if (smooths && order.before(other, l, LeafOrder::kSmoothing))
        graph.add_dependency(smooth(other), smooth(l));
      if (smooths) graph.add_dependency(smooth(other), emit(l));
      if (other < l) graph.add_dependency(export_triangles(other), emit(l));
    }
  }
}

LeafGraph::RoundNeeds LeafGraph::needs_of_rounds(const LeafOrder& order,
                                                 const std::vector<std::uint32_t>& next) {
  static_assert(kMigrationRounds == 2);
  RoundNeeds needs;
  needs.second = along_order(order, LeafOrder::kLaterRounds, first_around(order, next));
  // The second round of a leaf waits for the first round of those that overlap it that come later.
  needs.first = needs.second;
  for (std::uint32_t l = 0; l < order.size(); ++l) {
    for (const std::uint32_t other : order.overlapping(l)) {
      if (order.before(other, l, LeafOrder::kLaterRounds))
        needs.first[l] = std::min(needs.first[l], needs.second[other]);
    }
  }
  needs.first = along_order(order, LeafOrder::kFirstRound, std::move(needs.first));
  return needs;
}

std::vector<std::uint32_t> LeafGraph::needs(const LeafOrder& order, bool smooths) {
  const std::uint32_t n = order.size();
  std::vector<std::uint32_t> fragments(n);
  std::iota(fragments.begin(), fragments.end(), 0u);
  const std::vector<std::uint32_t> around = first_around(order, fragments);
  const std::vector<std::uint32_t> smoothed =
      smooths ? along_order(order, LeafOrder::kSmoothing, around) : fragments;
  std::vector<std::uint32_t> settled(n);
  std::transform(smoothed.begin(), smoothed.end(), around.begin(), settled.begin(),
                 [](std::uint32_t a, std::uint32_t b) { return std::min(a, b); });
  const std::vector<std::uint32_t> checked = first_around(order, settled);
  const RoundNeeds rounds = needs_of_rounds(order, checked);

  std::vector<std::uint32_t> result(std::size_t{n} * kTasks);
  for (std::uint32_t l = 0; l < n; ++l) {
    result[round(l, 0)] = rounds.first[l];
    result[round(l, 1)] = rounds.second[l];
    for (std::uint32_t r = kMigrationRounds; r < kRounds; ++r) result[round(l, r)] = checked[l];
    result[check_pending(l)] = checked[l];
    result[check_settled(l)] = settled[l];
    result[smooth(l)] = smoothed[l];
    result[number_vertices(l)] = result[export_triangles(l)] = result[emit(l)] = l;
  }
  return result;
}

}  // namespace weft
