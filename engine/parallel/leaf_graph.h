// SPDX-License-Identifier: Apache-2.0
// The tasks of the leaves and their dependencies: rounds of refinement, then smoothing, then the
// tasks that make the leaf a part of the sent mesh.
//
//   TaskGraph graph(order.size() * LeafGraph::kTasks);
//   LeafGraph::add_refinement(order, graph);
//   LeafGraph::add_parts(order, graph, true);
//   graph.set_needs(LeafGraph::needs(order, true));
//
// The memory of a mesh depends on how many leaves must have begun before the next one can be sent.
// Each of these tasks waits for the overlapping leaves, one step further ahead:
//   - the part, until they are smoothed, because that moves vertices of this leaf, too;
//   - the settling, until their rounds are done;
//   - each round, until their previous round is done.
// No task waits longer than necessary: a leaf is smoothed once the rounds around it are done,
// though it is final only one step later. And nearly all leaves are handed nothing in the second
// round, and skip the later ones without waiting for the order in them.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/trace.h"
#include "engine/parallel/leaf_order.h"
#include "engine/parallel/task_graph.h"

namespace weft {

struct LeafGraph {
  static constexpr std::uint32_t kHandOverRounds = 2;
  static constexpr std::uint32_t kRounds = 4;
  static constexpr std::uint32_t kTasks = kRounds + 6;  // of a leaf
  // Whether a leaf's task hands over bad triangles outside its leaf in this round.
  static constexpr bool hands_over(std::uint32_t round) { return round < kHandOverRounds; }
  static constexpr Trace::GraphName kName{"leaves",
                                          {"round 1", "round 2", "round 3", "round 4", "look",
                                           "settle", "smooth", "number", "hand on", "part"}};

  static std::uint32_t round(std::uint32_t leaf, std::uint32_t round) {
    return leaf * kTasks + round;
  }
  // A leaf's other tasks: test whether there is work for the rounds without handing over; test
  // whether the rounds settled the leaf; smooth; number; hand on triangles; build the part.
  static std::uint32_t look(std::uint32_t leaf) { return leaf * kTasks + kRounds; }
  static std::uint32_t settle(std::uint32_t leaf) { return leaf * kTasks + kRounds + 1; }
  static std::uint32_t smooth(std::uint32_t leaf) { return leaf * kTasks + kRounds + 2; }
  static std::uint32_t number(std::uint32_t leaf) { return leaf * kTasks + kRounds + 3; }
  static std::uint32_t hand_on(std::uint32_t leaf) { return leaf * kTasks + kRounds + 4; }
  static std::uint32_t part(std::uint32_t leaf) { return leaf * kTasks + kRounds + 5; }

  static void add_refinement(const LeafOrder& order, TaskGraph& graph);

  // A leaf is settled if neither it nor any leaf that overlaps it, which own a part of its halo,
  // has anything left. Then it is smoothed, if the mesh is. It is final if the overlapping leaves
  // are settled, too, because the clean-up needs room to work. It is sent once those are smoothed.
  static void add_parts(const LeafOrder& order, TaskGraph& graph, bool smooths);

  // Per task, the first part that waits for it, if all leaves skip the rounds that they may skip,
  // as nearly all do. For a graph with refinement and parts.
  static std::vector<std::uint32_t> needs(const LeafOrder& order, bool smooths);

  // The needs of the first two rounds, per leaf, from those of the next task, which waits for the
  // second round of the leaf and of the overlapping leaves.
  struct RoundNeeds {
    std::vector<std::uint32_t> first, second;
  };
  static RoundNeeds needs_of_rounds(const LeafOrder& order, const std::vector<std::uint32_t>& next);
};

}  // namespace weft
