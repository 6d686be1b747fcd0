// SPDX-License-Identifier: Apache-2.0
// The tasks of the leaves and what waits for what: rounds of refinement, then smoothing, then what
// makes a leaf a part of the mesh that is sent. Numbered by leaf, so that the first leaves are
// finished first.
//
//   TaskGraph graph(order.size() * LeafGraph::kTasks);
//   LeafGraph::add_refinement(order, graph);
//   LeafGraph::add_parts(order, graph, true);
#pragma once

#include <cstdint>

#include "engine/schedule/leaf_order.h"
#include "engine/schedule/task_graph.h"
#include "engine/schedule/trace.h"

namespace weft {

struct LeafGraph {
  static constexpr std::uint32_t kHandOverRounds = 2;
  static constexpr std::uint32_t kRounds = 4;
  static constexpr std::uint32_t kTasks = kRounds + 5;  // of a leaf
  // Whether a leaf's task hands over, in this round, what lies outside its leaf; and whether it may
  // have been handed anything.
  static constexpr bool hands_over(std::uint32_t round) { return round < kHandOverRounds; }
  static constexpr bool may_be_handed(std::uint32_t round) { return round <= kHandOverRounds; }
  static constexpr Trace::GraphName kName{"leaves",
                                          {"round 1", "round 2", "round 3", "round 4", "settle",
                                           "smooth", "number", "hand on", "part"}};

  static std::uint32_t round(std::uint32_t leaf, std::uint32_t round) {
    return leaf * kTasks + round;
  }
  // Whether the rounds settled the leaf; smoothing; its numbers; what it hands on; its part.
  static std::uint32_t settle(std::uint32_t leaf) { return leaf * kTasks + kRounds; }
  static std::uint32_t smooth(std::uint32_t leaf) { return leaf * kTasks + kRounds + 1; }
  static std::uint32_t number(std::uint32_t leaf) { return leaf * kTasks + kRounds + 2; }
  static std::uint32_t hand_on(std::uint32_t leaf) { return leaf * kTasks + kRounds + 3; }
  static std::uint32_t part(std::uint32_t leaf) { return leaf * kTasks + kRounds + 4; }

  static void add_refinement(const LeafOrder& order, TaskGraph& graph) {
    for (std::uint32_t l = 0; l < order.size(); ++l) {
      for (std::uint32_t r = 0; r < kRounds; ++r) {
        if (r > 0) graph.add_dependency(round(l, r - 1), round(l, r));
        for (const std::uint32_t other : order.conflicts(l)) {
          if (order.before(other, l)) {
            graph.add_dependency(round(other, r), round(l, r));
          } else if (r > 0) {
            graph.add_dependency(round(other, r - 1), round(l, r));
          }
        }
      }
    }
  }

  // A leaf is final once all that own a part of its grown box are done, and none of them, nor of
  // their own conflicts, has left anything to the clean-up: that must have room to work. Then it is
  // smoothed if the mesh is to be, and leaves once its conflicts are, too.
  static void add_parts(const LeafOrder& order, TaskGraph& graph, bool smooths) {
    for (std::uint32_t l = 0; l < order.size(); ++l) {
      graph.add_dependency(round(l, kRounds - 1), settle(l));
      graph.add_dependency(settle(l), smooth(l));
      graph.add_dependency(smooth(l), number(l));
      if (l > 0) graph.add_dependency(number(l - 1), number(l));
      graph.add_dependency(number(l), hand_on(l));
      graph.add_dependency(hand_on(l), part(l));
      for (const std::uint32_t other : order.conflicts(l)) {
        graph.add_dependency(round(other, kRounds - 1), settle(l));
        graph.add_dependency(settle(other), smooth(l));
        if (smooths && order.before(other, l)) graph.add_dependency(smooth(other), smooth(l));
        if (smooths) graph.add_dependency(smooth(other), part(l));
        if (other < l) graph.add_dependency(hand_on(other), part(l));
      }
    }
  }
};

}  // namespace weft
