// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/simplify/point_tree.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace weft {
namespace {

TEST(PointTree, FindsWhatItHolds) {
  const ExecutionContext context;
  StopPoller poller(context);
  std::mt19937 random(3);
  const auto unit = [&] { return random() / 4294967296.0; };
  std::vector<Point> points;
  for (int i = 0; i < 300; ++i) points.push_back({unit(), unit()});
  points.push_back(points[7]);
  std::vector<bool> held(points.size(), true);
  held[20] = false;
  PointTree tree(points, held, poller);
  for (int round = 0; round < 300; ++round) {
    Box box;
    box.add({unit(), unit()});
    box.add({unit(), unit()});
    std::set<std::uint32_t> expected, found;
    for (std::uint32_t i = 0; i < points.size(); ++i)
      if (held[i] && points[i].x >= box.min_x && points[i].x <= box.max_x &&
          points[i].y >= box.min_y && points[i].y <= box.max_y)
        expected.insert(i);
    EXPECT_TRUE(tree.for_each_in(box, [&](std::uint32_t i) { return found.insert(i).second; }));
    EXPECT_EQ(found, expected);
    const auto gone = static_cast<std::uint32_t>(random() % points.size());
    if (!held[gone]) continue;
    held[gone] = false;
    tree.remove(gone);
  }
}

TEST(PointTree, StopsWhenTold) {
  const ExecutionContext context;
  StopPoller poller(context);
  const std::vector<Point> points{{0, 0}, {1, 1}, {2, 2}};
  const PointTree tree(points, {true, true, true}, poller);
  int visits = 0;
  EXPECT_FALSE(tree.for_each_in({0, 0, 2, 2}, [&](std::uint32_t) { return ++visits < 2; }));
  EXPECT_EQ(visits, 2);
}

TEST(PointTree, MayBeEmpty) {
  const ExecutionContext context;
  StopPoller poller(context);
  const std::vector<Point> points{{0, 0}};
  const PointTree tree(points, {false}, poller);
  EXPECT_TRUE(tree.for_each_in({-1, -1, 1, 1}, [](std::uint32_t) { return false; }));
}

}  // namespace
}  // namespace weft
