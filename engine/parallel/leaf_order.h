// SPDX-License-Identifier: Apache-2.0
// Which leaves' tasks are in conflict because their grown boxes overlap, and which of two in
// conflict comes first. The order depends only on the tree. It differs by phase:
//
//   - The first round has nearly all the work. If there are at most 256 leaves, each, the heaviest
//     first, is given the earliest time at which no leaf in conflict is at work, and the
//     earlier one comes first. So the heaviest chain of leaves that wait for one another is short.
//     If there are more, the larger leaf comes first; of equal leaves, the one of the lower colour,
//     of four colours in blocks of two by two. Chains matter less there, and memory more.
//   - Later rounds take little time. Equal leaves are ordered by the parity of their row, and then
//     along the sweep (quadtree.h), so no leaf waits for others far ahead of the sweep.
//   - Smoothing goes as the first round if there are at most 256 leaves. If there are more, it goes
//     along the sweep: by where a leaf begins, and equal leaves by the parity of their row. So no
//     leaf waits for others ahead.
//
// The cylinder with 0.63 M triangles, in 97 leaves, by the times of its tasks, and its longest
// chain in the first round and in smoothing:
//
//                         4 threads   8     16    64     chain, ms
//   colours, sweep        3.5         4.5   4.8   4.8    10.3, 8.5
//   earliest time         3.4         5.7   6.6   6.6     8.7, 3.0
//
// The leaves ahead of the sweep that a leaf waits for must be in memory before it can be sent
// (leaf_graph.h). The largest share of the mesh that has begun and is not sent, in percent, in the
// schedule of two threads (weft-bench scaling predicts such schedules); from recorded tasks of 10 M
// triangles on the cylinder with two sizes, with a constant size, and on the pipe, in leaves of at
// most 4,000:
//
//   first round   later rounds   smoothing   numbered by     cylinder   constant   pipe
//   2 x 2         rows           rows        beginning       16.2       22.7       26.4
//   2 x 2         2 x 2          2 x 2       beginning       18.0       23.6       31.3
//   2 x 2         rows           sweep       beginning       17.1       26.8       20.9
//   2 x 2         rows           sweep       middle          13.6       19.1       21.4   <- this
//   sweep         sweep          sweep       beginning       50.4
//
//   const LeafOrder order(tree);
//   for (const std::uint32_t other : order.conflicts(leaf))
//     if (order.before(other, leaf, LeafOrder::kFirstRound)) graph.add_dependency(other, leaf);
//
// Thread-safety: immutable once built.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/parallel/quadtree.h"

namespace weft {

class LeafOrder {
 public:
  enum Phase : std::uint8_t { kFirstRound, kLaterRounds, kSmoothing };
  static constexpr std::size_t kPhases = 3;

  LeafOrder() = default;
  explicit LeafOrder(const Quadtree& tree);
  // A different order: along the sweep in all phases.
  static LeafOrder along_sweep(const Quadtree& tree);

  // The phase of a round, counted from 0.
  static constexpr Phase phase_of(std::uint32_t round) {
    return round == 0 ? kFirstRound : kLaterRounds;
  }

  std::uint32_t size() const { return static_cast<std::uint32_t>(conflicts_.size()); }
  // The leaves in conflict with `leaf`, in order.
  const std::vector<std::uint32_t>& conflicts(std::uint32_t leaf) const { return conflicts_[leaf]; }
  bool in_conflict(std::uint32_t leaf, std::uint32_t other) const;
  // Whether `leaf` comes before `other` in a phase. REQUIRES: they are in conflict.
  bool before(std::uint32_t leaf, std::uint32_t other, Phase phase) const {
    return rank_[phase][leaf] < rank_[phase][other];
  }
  // All leaves, in the order of a phase.
  std::vector<std::uint32_t> all(Phase phase) const;

  std::size_t bytes() const;

 private:
  std::vector<std::vector<std::uint32_t>> conflicts_;
  std::array<std::vector<std::uint32_t>, kPhases> rank_;  // per leaf
};

}  // namespace weft
