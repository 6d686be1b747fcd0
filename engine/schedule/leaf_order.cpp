// SPDX-License-Identifier: Apache-2.0
#include "engine/schedule/leaf_order.h"

#include <algorithm>
#include <numeric>
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

}  // namespace

LeafOrder::LeafOrder(const Quadtree& tree) : conflicts_(tree.conflicts()) {
  const auto& leaves = tree.leaves();
  rank_[kFirstRound] = ranks(leaves, [](const Quadtree::Leaf& l) {
    return std::tuple(l.depth, l.along & 1, l.across & 1);
  });
  rank_[kLaterRounds] =
      ranks(leaves, [](const Quadtree::Leaf& l) { return std::tuple(l.depth, l.across & 1); });
  rank_[kSmoothing] = ranks(leaves, [](const Quadtree::Leaf& l) {
    return std::tuple(l.along << (Quadtree::kMaxDepth - l.depth), l.across & 1);
  });
}

LeafOrder LeafOrder::along_sweep(const Quadtree& tree) {
  LeafOrder order;
  order.conflicts_ = tree.conflicts();
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

bool LeafOrder::in_conflict(std::uint32_t leaf, std::uint32_t other) const {
  return std::binary_search(conflicts_[leaf].begin(), conflicts_[leaf].end(), other);
}

std::size_t LeafOrder::bytes() const {
  std::size_t bytes = conflicts_.capacity() * sizeof(std::vector<std::uint32_t>);
  for (const auto& rank : rank_) bytes += rank.capacity() * sizeof(std::uint32_t);
  for (const auto& c : conflicts_) bytes += c.capacity() * sizeof(std::uint32_t);
  return bytes;
}

}  // namespace weft
