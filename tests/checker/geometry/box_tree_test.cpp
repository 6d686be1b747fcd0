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

TEST(BoxTree, FindsTheBoxOfTheLeastCost) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(0, 1), extent(0, 0.1);
  std::vector<Box> boxes;
  std::vector<double> floors;
  for (int i = 0; i < 500; ++i) {
    const double x = place(random), y = place(random);
    boxes.push_back({x, y, x + extent(random), y + extent(random)});
    floors.push_back(place(random));
  }
  const BoxTree plain(boxes);
  const BoxTree raised(boxes, floors);
  for (int q = 0; q < 200; ++q) {
    const Vec2 p{place(random), place(random)};
    double expected_plain = 2, expected_raised = 2;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
      expected_plain = std::min(expected_plain, boxes[i].distance(p));
      expected_raised = std::min(expected_raised, floors[i] + 3 * boxes[i].distance(p));
    }
    double least = 2;
    const auto distance = [&](std::uint32_t i) { return boxes[i].distance(p); };
    ASSERT_TRUE(plain.least(p, 1, least, distance));
    EXPECT_EQ(least, expected_plain);
    EXPECT_FALSE(plain.least(p, 1, least, distance));
    least = 2;
    const auto found =
        raised.least(p, 3, least, [&](std::uint32_t i) { return floors[i] + 3 * distance(i); });
    ASSERT_TRUE(found);
    EXPECT_EQ(least, expected_raised);
    EXPECT_EQ(floors[*found] + 3 * boxes[*found].distance(p), expected_raised);
  }
}

TEST(BoxTree, LooksAtFewForTheLeast) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> place(0, 1);
  std::vector<Box> boxes;
  for (int i = 0; i < 100000; ++i) {
    const Vec2 p{place(random), place(random)};
    boxes.push_back(box_of(p, p));
  }
  const BoxTree tree(boxes);
  std::uint64_t looks = 0;
  for (int q = 0; q < 1000; ++q) {
    const Vec2 p{place(random), place(random)};
    double least = 2;
    tree.least(p, 1, least, [&](std::uint32_t i) { return ++looks, boxes[i].distance(p); });
  }
  EXPECT_LT(looks, 20u * 1000);
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
