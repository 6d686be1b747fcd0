// SPDX-License-Identifier: Apache-2.0
#include "engine/parallel/leaf_order.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <tuple>

namespace weft {
namespace {

// The place of each leaf if all are sorted by a key, and by their numbers where it is the same.
template <class Key>
std::vector<std::uint32_t> ranks(const std::vector<Quadtree::Leaf>& leaves, Key key) {
  std::vector<std::uint32_t> order(leaves.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tuple_cat(key(leaves[a]), std::tuple(a)) <
           std::tuple_cat(key(leaves[b]), std::tuple(b));
  });
  std::vector<std::uint32_t> rank(leaves.size());
  for (std::uint32_t i = 0; i < rank.size(); ++i) rank[order[i]] = i;
  return rank;
}

// The place of each leaf if all are sorted by when they begin, by colouring of intervals: from the
// heaviest leaf on, and those with rows before the others, each begins at the earliest time at
// which no overlapping leaf is at work.
std::vector<std::uint32_t> ranks_by_start(
    const std::vector<Quadtree::Leaf>& leaves,
    const std::vector<std::vector<std::uint32_t>>& overlapping,
    const LeafOrder::MayHaveRows& may_have_rows) {
  constexpr double kMinWork = 0.02;  // of the mean: every task costs something
  struct Interval {
    double begin;
    double end;
  };
  const double all =
      std::accumulate(leaves.begin(), leaves.end(), 0.0,
                      [](double sum, const Quadtree::Leaf& l) { return sum + l.weight; });
  const double least = kMinWork * all / static_cast<double>(leaves.size());
  const auto work = [&](std::uint32_t l) { return std::max(leaves[l].weight, least); };

  std::vector<std::uint32_t> heaviest_first(leaves.size());
  std::iota(heaviest_first.begin(), heaviest_first.end(), 0u);
  std::stable_sort(
      heaviest_first.begin(), heaviest_first.end(),
      [&](std::uint32_t a, std::uint32_t b) { return leaves[a].weight > leaves[b].weight; });
  std::stable_partition(heaviest_first.begin(), heaviest_first.end(),
                        [&](std::uint32_t l) { return may_have_rows(leaves[l]); });
  std::vector<std::optional<double>> begin(leaves.size());
  std::vector<Interval> busy;
  for (const std::uint32_t leaf : heaviest_first) {
    busy.clear();
    for (const std::uint32_t other : overlapping[leaf]) {
      if (begin[other]) busy.push_back({*begin[other], *begin[other] + work(other)});
    }
    std::sort(busy.begin(), busy.end(),
              [](const Interval& a, const Interval& b) { return a.begin < b.begin; });
    double at = 0;
    for (const Interval& other : busy) {
      if (at + work(leaf) <= other.begin) break;
      at = std::max(at, other.end);
    }
    begin[leaf] = at;
  }
  return ranks(leaves, [&](const Quadtree::Leaf& l) {
    return std::tuple(*begin[static_cast<std::size_t>(&l - leaves.data())]);
  });
}

}  // namespace

LeafOrder::LeafOrder(const Quadtree& tree, const MayHaveRows& may_have_rows)
    : overlapping_(tree.overlapping()) {
  const auto& leaves = tree.leaves();
  rank_[kLaterRounds] =
      ranks(leaves, [](const Quadtree::Leaf& l) { return std::tuple(l.depth, l.across & 1); });
  if (leaves.size() <= kFewLeaves) {
    rank_[kFirstRound] = ranks_by_start(leaves, overlapping_, may_have_rows);
    rank_[kSmoothing] = rank_[kFirstRound];
    return;
  }
  rank_[kFirstRound] = ranks(leaves, [](const Quadtree::Leaf& l) {
    return std::tuple(l.depth, l.along & 1, l.across & 1);
  });
  rank_[kSmoothing] = ranks(leaves, [](const Quadtree::Leaf& l) {
    return std::tuple(l.along << (Quadtree::kMaxDepth - l.depth), l.across & 1);
  });
}

LeafOrder LeafOrder::along_sweep(const Quadtree& tree) {
  LeafOrder order;
  order.overlapping_ = tree.overlapping();
  for (auto& rank : order.rank_) {
    rank.resize(order.size());
    std::iota(rank.begin(), rank.end(), 0u);
  }
  return order;
}

std::vector<std::uint32_t> LeafOrder::all(Phase phase) const {
  std::vector<std::uint32_t> order(size());
  for (std::uint32_t l = 0; l < size(); ++l) order[rank_[phase][l]] = l;
  return order;
}

bool LeafOrder::overlap(std::uint32_t leaf, std::uint32_t other) const {
  return std::binary_search(overlapping_[leaf].begin(), overlapping_[leaf].end(), other);
}

std::size_t LeafOrder::bytes() const {
  std::size_t bytes = overlapping_.capacity() * sizeof(std::vector<std::uint32_t>);
  for (const auto& rank : rank_) bytes += rank.capacity() * sizeof(std::uint32_t);
  for (const auto& c : overlapping_) bytes += c.capacity() * sizeof(std::uint32_t);
  return bytes;
}

}  // namespace weft
