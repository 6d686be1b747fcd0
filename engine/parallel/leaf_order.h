// SPDX-License-Identifier: Apache-2.0
// Which leaves overlap, and which of two that overlap comes first. Two leaves overlap if their
// halos do: then their tasks run one after the other. The order depends only on the tree, so the
// mesh does not depend on threads. It differs by phase:
//
//   - The first round has nearly all the work. If there are at most 256 leaves, each, the heaviest
//     first, is given the earliest time at which no overlapping leaf is at work, and the earlier
//     one comes first: the heaviest chain of leaves that wait for one another is short. Those that
//     rows of a lattice may fill (refine/row_filler.h) choose before the rest, because vertices of
//     others that went first would be in the way of the rows. If there
//     are more, the larger leaf comes first, and among equal leaves the one of the lower colour, of
//     four colours in blocks of two by two: chains matter less, and memory more.
//   - Later rounds take little time. Equal leaves are ordered by the parity of their row, and then
//     along the sweep (quadtree.h), so no leaf waits for others far ahead of the sweep.
//   - Smoothing follows the order of the first round if there are at most 256 leaves. If there are
//     more, it goes along the sweep: by where a leaf begins, and equal leaves by the parity of
//     their row. So no leaf waits for others ahead.
//
// The leaves ahead of the sweep that a leaf waits for must be in memory before it can be sent
// (leaf_graph.h). bench/README.md compares other orders.
//
//   const LeafOrder order(tree);
//   for (const std::uint32_t other : order.overlapping(leaf))
//     if (order.before(other, leaf, LeafOrder::kFirstRound)) graph.add_dependency(other, leaf);
//
// Thread-safety: immutable once built.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "engine/parallel/quadtree.h"

namespace weft {

class LeafOrder {
 public:
  enum Phase : std::uint8_t { kFirstRound, kLaterRounds, kSmoothing };
  static constexpr std::size_t kPhases = 3;
  // Up to so many leaves, short chains matter more than memory.
  static constexpr std::size_t kFewLeaves = 256;

  LeafOrder() = default;
  // `may_have_rows` says which leaves rows may fill. DEFAULT: all or none.
  using MayHaveRows = std::function<bool(const Quadtree::Leaf&)>;
  explicit LeafOrder(
      const Quadtree& tree,
      const MayHaveRows& may_have_rows = [](const Quadtree::Leaf&) { return true; });
  // A different order: along the sweep in all phases.
  static LeafOrder along_sweep(const Quadtree& tree);

  // The phase of a round, counted from 0.
  static constexpr Phase phase_of(std::uint32_t round) {
    return round == 0 ? kFirstRound : kLaterRounds;
  }

  std::uint32_t size() const { return static_cast<std::uint32_t>(overlapping_.size()); }
  // The leaves that overlap `leaf`, in order.
  const std::vector<std::uint32_t>& overlapping(std::uint32_t leaf) const {
    return overlapping_[leaf];
  }
  bool overlap(std::uint32_t leaf, std::uint32_t other) const;
  // Whether `leaf` comes before `other` in a phase. REQUIRES: they overlap.
  bool before(std::uint32_t leaf, std::uint32_t other, Phase phase) const {
    return rank_[phase][leaf] < rank_[phase][other];
  }
  // All leaves, in the order of a phase.
  std::vector<std::uint32_t> all(Phase phase) const;

  std::size_t bytes() const;

 private:
  std::vector<std::vector<std::uint32_t>> overlapping_;
  std::array<std::vector<std::uint32_t>, kPhases> rank_;  // per leaf
};

}  // namespace weft
