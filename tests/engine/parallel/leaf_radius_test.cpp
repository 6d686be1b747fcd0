// SPDX-License-Identifier: Apache-2.0
#include "engine/parallel/leaf_radius.h"

#include <gtest/gtest.h>

#include <vector>

#include "engine/parallel/quadtree.h"
#include "engine/refine/area_bound.h"

namespace weft {
namespace {

constexpr double kTarget = 100;
constexpr double kDense = 6;

// Of a square of side 64 with this weight at the middle of each unit square up to `side`.
Quadtree tree_of(int side, double weight) {
  std::vector<Quadtree::Sample> samples;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) samples.push_back({{x + 0.5, y + 0.5}, weight});
  samples.push_back({{63.5, 63.5}, 1});
  Box box;
  box.add({0, 0});
  box.add({64, 64});
  return Quadtree::build(box, samples, kTarget);
}

TEST(LeafRadius, AsksAllLeavesIfNearlyAllAreFull) {
  const Quadtree tree = tree_of(64, 10);
  ASSERT_GT(tree.leaves().size(), 256u);
  EXPECT_EQ(dense_weight(tree, kDense), 0);
  const LeafRadius radius(tree, dense_weight(tree, kDense), ConstantArea(1), ExecutionContext());
  for (const Quadtree::Leaf& leaf : tree.leaves()) {
    const Point middle{0.5 * (leaf.box.min_x + leaf.box.max_x),
                       0.5 * (leaf.box.min_y + leaf.box.max_y)};
    EXPECT_EQ(radius.limit_at(middle), LeafRadius<ConstantArea>::kRadiusPerSide * leaf.side());
  }
}

TEST(LeafRadius, SparesTheLightLeavesAroundASpot) {
  const Quadtree tree = tree_of(8, 10);
  EXPECT_EQ(dense_weight(tree, kDense), kDense);
  const LeafRadius radius(tree, dense_weight(tree, kDense), ConstantArea(1), ExecutionContext());
  EXPECT_GT(radius.limit_at({63, 63}), 16);
}

}  // namespace
}  // namespace weft
