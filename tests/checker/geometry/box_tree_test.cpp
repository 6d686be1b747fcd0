// SPDX-License-Identifier: Apache-2.0
#include "checker/geometry/box_tree.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace weft::check {
namespace {

TEST(BoxTree, FindsTheBoxesThatMeetAQueryAndNoOthers) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> place(0, 1), extent(0, 0.1);
  std::vector<Box> boxes;
  for (int i = 0; i < 500; ++i) {
    const double x = place(random), y = place(random);
    boxes.push_back({x, y, x + extent(random), y + extent(random)});
  }
  const BoxTree tree(boxes);
  for (int q = 0; q < 100; ++q) {
    const double x = place(random), y = place(random);
    const Box query{x, y, x + extent(random), y + extent(random)};
    std::set<std::uint32_t> expected, found;
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
      if (boxes[i].meets(query)) expected.insert(i);
    tree.visit(query, [&](std::uint32_t i) { EXPECT_TRUE(found.insert(i).second); });
    EXPECT_EQ(found, expected);
  }
}

TEST(BoxTree, OfNothingFindsNothing) {
  BoxTree({}).visit({0, 0, 1, 1}, [](std::uint32_t) { FAIL(); });
}

TEST(BoxTree, HoldsManyBoxesAtOnePlace) {
  const BoxTree tree(std::vector<Box>(1000, Box{1, 1, 1, 1}));
  int found = 0;
  tree.visit({0, 0, 1, 1}, [&](std::uint32_t) { ++found; });
  EXPECT_EQ(found, 1000);
}

TEST(BoxTree, SkipsWhatTheShrunkQueryLeavesOut) {
  std::vector<Box> boxes;
  for (int i = 0; i < 1000; ++i) boxes.push_back({1.0 * i, 0, 1.0 * i, 1});
  const BoxTree tree(boxes);
  Box query{0, 0, 1000, 1};
  int visited = 0;
  tree.visit(query, [&](std::uint32_t i) {
    ++visited;
    query.min_x = std::max(query.min_x, boxes[i].min_x);
  });
  EXPECT_EQ(query.min_x, 999);
  EXPECT_LT(visited, 20);
}

}  // namespace
}  // namespace weft::check
