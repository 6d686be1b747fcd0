// SPDX-License-Identifier: Apache-2.0
// The tasks of the leaves and their dependencies: rounds of refinement, then smoothing, then the
// tasks that emit the leaf as a fragment of the mesh.
//
//   round 1, 2, 3, 4   refine; 1 and 2 let bad triangles migrate (leaf_tasks.h)
//   check pending      after round 2: skips rounds 3 and 4 of a leaf that has no work for them
//   check settled      whether the rounds have left nothing pending in the leaf and around
//   smooth             move its vertices to where angles are larger (refine/smoothing/smoother.h)
//   number             give the leaf's vertices their numbers in the mesh
//   export             copy the triangles that go into the fragment of another leaf
//   emit               build the fragment, to be sent
//
//   TaskGraph graph(order.size() * LeafGraph::kTasks);
//   LeafGraph::add_refinement(order, graph);
//   LeafGraph::add_emission(order, graph, true);
//   graph.set_needs(LeafGraph::needs(order, true));
//
// The memory of a mesh is that of the leaves that have begun and are not sent. Which leaves must
// have begun before leaf l can be sent follows from what its tasks wait for, each in the leaves
// that overlap one ring further out:
//   - its fragment, for their smoothing, because that moves vertices of l, too;
//   - their smoothing, for the rounds of the leaves that overlap them;
//   - each round, for the previous round of the leaves that overlap.
// No task waits longer than necessary: a leaf is smoothed once the rounds around it are done,
// though it is final only when those around are settled, too. Nearly all leaves receive nothing in
// the second round, and skip the later ones without waiting for the order in them.
//
// Thread-safety: pure functions of their arguments.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/trace.h"
#include "engine/parallel/leaf_order.h"
#include "engine/parallel/task_graph.h"

namespace weft {

struct LeafGraph {
  static constexpr std::uint32_t kMigrationRounds = 2;
  static constexpr std::uint32_t kRounds = 4;
  static constexpr std::uint32_t kTasks = kRounds + 6;  // of a leaf
  // Whether a leaf's task passes bad triangles outside its leaf to the leaf there in this round.
  static constexpr bool migrates(std::uint32_t round) { return round < kMigrationRounds; }
  static constexpr Trace::GraphName kName{
      "leaves",
      {"round 1", "round 2", "round 3", "round 4", "check pending", "check settled", "smooth",
       "number", "export", "emit"}};
  // About how long each takes, in tenths of round 1: smoothing and building a fragment take half.
  static constexpr std::uint8_t kCosts[kTasks] = {10, 1, 1, 1, 1, 1, 5, 1, 1, 5};

  static std::uint32_t round(std::uint32_t leaf, std::uint32_t round) {
    return leaf * kTasks + round;
  }
  // A leaf's other tasks.
  static std::uint32_t check_pending(std::uint32_t leaf) { return leaf * kTasks + kRounds; }
  static std::uint32_t check_settled(std::uint32_t leaf) { return leaf * kTasks + kRounds + 1; }
  static std::uint32_t smooth(std::uint32_t leaf) { return leaf * kTasks + kRounds + 2; }
  static std::uint32_t number_vertices(std::uint32_t leaf) { return leaf * kTasks + kRounds + 3; }
  static std::uint32_t export_triangles(std::uint32_t leaf) { return leaf * kTasks + kRounds + 4; }
  static std::uint32_t emit(std::uint32_t leaf) { return leaf * kTasks + kRounds + 5; }

  static void add_refinement(const LeafOrder& order, TaskGraph& graph);

  // A leaf is settled if neither it nor any leaf that overlaps it, which own a part of its halo,
  // has anything pending. Then it is smoothed, if the mesh is. It is final if the overlapping
  // leaves are settled, too, because the clean-up needs room to work. It is sent once those are
  // smoothed.
  static void add_emission(const LeafOrder& order, TaskGraph& graph, bool smooths);

  // Per task, the first fragment that waits for it, if all leaves skip the rounds that they may
  // skip, as nearly all do. For a graph with refinement and fragments.
  static std::vector<std::uint32_t> needs(const LeafOrder& order, bool smooths);

  // The needs of the first two rounds, per leaf, from those of the next task, which waits for the
  // second round of the leaf and of the overlapping leaves.
  struct RoundNeeds {
    std::vector<std::uint32_t> first, second;
  };
  static RoundNeeds needs_of_rounds(const LeafOrder& order, const std::vector<std::uint32_t>& next);
};

}  // namespace weft
