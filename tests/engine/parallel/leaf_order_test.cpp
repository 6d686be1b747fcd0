// SPDX-License-Identifier: Apache-2.0
#include "engine/parallel/leaf_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

namespace weft {
namespace {

constexpr int kSamples = 20'000;

// Leaves of different sizes and weights, of at most so many samples each.
Quadtree tree_of(double samples_per_leaf, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  std::vector<Quadtree::Sample> samples;
  for (int i = 0; i < kSamples; ++i) {
    const double x = unit();
    samples.push_back({{3 * x * x, unit()}, 1});
  }
  Box domain;
  domain.add({0, 0});
  domain.add({3, 1});
  return Quadtree::build(domain, samples, samples_per_leaf);
}

// The weight of the heaviest chain of leaves that wait for one another.
double heaviest_chain(const Quadtree& tree, const LeafOrder& order, LeafOrder::Phase phase) {
  double most = 0;
  std::vector<double> end(order.size());
  for (const std::uint32_t leaf : order.all(phase)) {
    double begin = 0;
    for (const std::uint32_t other : order.overlapping(leaf)) {
      if (order.before(other, leaf, phase)) begin = std::max(begin, end[other]);
    }
    end[leaf] = begin + tree.leaves()[leaf].weight;
    most = std::max(most, end[leaf]);
  }
  return most;
}

// The order of later rounds is by size and row.
TEST(LeafOrder, OfFewLeavesHasShortChains) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Quadtree tree = tree_of(300, seed);
    ASSERT_LE(tree.leaves().size(), 256u);
    const LeafOrder order(tree);
    for (const auto phase : {LeafOrder::kFirstRound, LeafOrder::kSmoothing}) {
      EXPECT_LT(heaviest_chain(tree, order, phase),
                0.8 * heaviest_chain(tree, order, LeafOrder::kLaterRounds));
    }
  }
}

TEST(LeafOrder, LetsLeavesWithRowsChooseFirst) {
  const Quadtree tree = tree_of(300, 1);
  const auto& leaves = tree.leaves();
  int choose_later = 0;
  for (std::uint32_t leaf = 0; leaf < leaves.size(); ++leaf) {
    const auto is_first = [&](const LeafOrder& order) {
      const auto& others = order.overlapping(leaf);
      return std::all_of(others.begin(), others.end(), [&](std::uint32_t other) {
        return order.before(leaf, other, LeafOrder::kFirstRound);
      });
    };
    choose_later += !is_first(LeafOrder(tree));
    EXPECT_TRUE(
        is_first(LeafOrder(tree, [&](const Quadtree::Leaf& l) { return &l == &leaves[leaf]; })));
  }
  EXPECT_GT(choose_later, 50);
}

TEST(LeafOrder, OfManyLeavesSmoothsAlongTheSweep) {
  const Quadtree tree = tree_of(50, 1);
  ASSERT_GT(tree.leaves().size(), 256u);
  const std::vector<std::uint32_t> all = LeafOrder(tree).all(LeafOrder::kSmoothing);
  const auto begins = [&](std::uint32_t l) {
    const Quadtree::Leaf& leaf = tree.leaves()[l];
    return leaf.along << (Quadtree::kMaxDepth - leaf.depth);
  };
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end(), [&](std::uint32_t a, std::uint32_t b) {
    return begins(a) < begins(b);
  }));
}

}  // namespace
}  // namespace weft
