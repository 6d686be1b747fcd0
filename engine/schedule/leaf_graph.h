// SPDX-License-Identifier: Apache-2.0
// The tasks of the leaves and what waits for what: rounds of refinement, then smoothing, then what
// makes a leaf a part of the mesh that is sent.
//
//   TaskGraph graph(order.size() * LeafGraph::kTasks);
//   LeafGraph::add_refinement(order, graph);
//   LeafGraph::add_parts(order, graph, true);
//   graph.set_needs(LeafGraph::needs(order, true));
//
// How far ahead of the leaf that is to be sent others must have begun decides the memory that a
// mesh takes. Each of these waits for the leaves in conflict, one step further ahead:
//   - the part, until they are smoothed, which moves vertices of this leaf, too;
//   - the settling, until their rounds are done;
//   - each round, until their round before it is done.
// So nothing waits further than it must: a leaf is smoothed once the rounds around it are done,
// though it is final only one step later. And a leaf that is handed nothing in the second round,
// as nearly all, skips the later ones without waiting for the order in them.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/task_graph.h"
#include "engine/base/trace.h"
#include "engine/schedule/leaf_order.h"

namespace weft {

struct LeafGraph {
  static constexpr std::uint32_t kHandOverRounds = 2;
  static constexpr std::uint32_t kRounds = 4;
  static constexpr std::uint32_t kTasks = kRounds + 6;  // of a leaf
  // Whether a leaf's task hands over, in this round, what lies outside its leaf.
  static constexpr bool hands_over(std::uint32_t round) { return round < kHandOverRounds; }
  static constexpr Trace::GraphName kName{"leaves",
                                          {"round 1", "round 2", "round 3", "round 4", "look",
                                           "settle", "smooth", "number", "hand on", "part"}};

  static std::uint32_t round(std::uint32_t leaf, std::uint32_t round) {
    return leaf * kTasks + round;
  }
  // Whether there is anything left for the rounds in which nothing is handed over; whether the
  // rounds settled the leaf; smoothing; its numbers; what it hands on; its part.
  static std::uint32_t look(std::uint32_t leaf) { return leaf * kTasks + kRounds; }
  static std::uint32_t settle(std::uint32_t leaf) { return leaf * kTasks + kRounds + 1; }
  static std::uint32_t smooth(std::uint32_t leaf) { return leaf * kTasks + kRounds + 2; }
  static std::uint32_t number(std::uint32_t leaf) { return leaf * kTasks + kRounds + 3; }
  static std::uint32_t hand_on(std::uint32_t leaf) { return leaf * kTasks + kRounds + 4; }
  static std::uint32_t part(std::uint32_t leaf) { return leaf * kTasks + kRounds + 5; }

  static void add_refinement(const LeafOrder& order, TaskGraph& graph);

  // A leaf is settled if neither it nor any in conflict with it, which own a part of its grown box,
  // has anything left. Then it is smoothed if the mesh is to be. It is final if those in conflict
  // are settled, too, because the clean-up must have room to work, and leaves once they are
  // smoothed.
  static void add_parts(const LeafOrder& order, TaskGraph& graph, bool smooths);

  // Per task, the first part that waits for it, as if all leaves skipped the rounds that they may
  // skip: so it is for all but a few. Of a graph with refinement and parts.
  static std::vector<std::uint32_t> needs(const LeafOrder& order, bool smooths);

  // The same of the first two rounds, per leaf, from that of what comes next, which waits for the
  // second round of the leaf and of those in conflict.
  struct RoundNeeds {
    std::vector<std::uint32_t> first, second;
  };
  static RoundNeeds needs_of_rounds(const LeafOrder& order, const std::vector<std::uint32_t>& next);
};

}  // namespace weft
