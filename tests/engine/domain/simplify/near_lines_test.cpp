// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/simplify/near_lines.h"

#include <gtest/gtest.h>

#include <random>

#include "engine/domain/arrangement/snapping.h"

namespace weft {
namespace {

LineGraph random_lines(std::mt19937& random, int count) {
  LineGraph graph;
  const auto unit = [&] { return random() / 4294967296.0; };
  for (int i = 0; i < count; ++i) {
    const Point p{unit(), unit()};
    graph.add_point(p, kNone, 0, 0);
    graph.add_point({p.x + 0.1 * unit(), p.y + 0.1 * unit()}, kNone, 0, 0);
    graph.lines.push_back(
        {.a = static_cast<std::uint32_t>(2 * i), .b = static_cast<std::uint32_t>(2 * i + 1)});
  }
  return graph;
}

double brute_force(const LineGraph& graph, Point p) {
  double least = 1e300;
  for (const GraphLine& line : graph.lines)
    least = std::min(least, distance_to_segment(p, graph.points[line.a], graph.points[line.b]));
  return least;
}

TEST(NearLines, FindsTheDistanceToTheNearest) {
  const ExecutionContext context;
  StopPoller poller(context);
  std::mt19937 random(5);
  for (const int count : {1, 2, 7, 60}) {
    const LineGraph graph = random_lines(random, count);
    const NearLines near(graph, poller);
    for (int i = 0; i < 200; ++i) {
      const Point p{random() / 4294967296.0, random() / 4294967296.0};
      EXPECT_EQ(near.distance(p, 10), brute_force(graph, p));
      EXPECT_EQ(near.distance(p, 1e-3), std::min(1e-3, brute_force(graph, p)));
    }
  }
}

LineGraph one_line() {
  LineGraph graph;
  graph.add_point({0, 0}, kNone, 0, 0);
  graph.add_point({10, 0}, kNone, 0, 0);
  graph.lines.push_back({.a = 0, .b = 1});
  return graph;
}

TEST(NearLines, HoldsTrianglesNear) {
  const ExecutionContext context;
  StopPoller poller(context);
  const NearLines near(one_line(), poller);
  EXPECT_TRUE(near.holds_near({Point{0, 0}, {10, 0}, {5, 0.9}}, 1));
  EXPECT_FALSE(near.holds_near({Point{0, 0}, {10, 0}, {5, 1.1}}, 1));
  EXPECT_TRUE(near.holds_near({Point{0, 0}, {10, 0}, {10, 0}}, 1));  // flat
  EXPECT_FALSE(near.holds_near({Point{4, -2}, {6, -2}, {5, 2}}, 1));
}

// Far more disks than are looked at would cover it.
TEST(NearLines, HoldsATriangleAlongALineHoweverLong) {
  const ExecutionContext context;
  StopPoller poller(context);
  LineGraph graph = one_line();
  graph.points[1] = {1e5, 0};
  const NearLines near(graph, poller);
  EXPECT_TRUE(near.holds_near({Point{0, 0.9}, {1e5, 0.9}, {5e4, -0.9}}, 1));
  EXPECT_FALSE(near.holds_near({Point{0, 0.9}, {1e5, 0.9}, {5e4, -1.1}}, 1));
}

// Many questions share a place in what is remembered.
TEST(NearLines, TakesNoTriangleForAnother) {
  const ExecutionContext context;
  StopPoller poller(context);
  std::mt19937 random(7);
  LineGraph graph = random_lines(random, 20);
  for (std::size_t l = 0; l < graph.lines.size(); l += 2) graph.lines[l].marker = 3;
  const NearLines near(graph, poller);
  int yes = 0;
  for (int i = 0; i < 20'000; ++i) {
    const auto corner = [&] { return graph.points[random() % 3]; };
    const std::array<Point, 3> triangle{corner(), corner(), corner()};
    const double within = random() % 2 == 0 ? 0.3 : 0.1;
    const NearLines::Marker marker =
        random() % 2 == 0 ? std::nullopt : NearLines::Marker(random() % 2 == 0 ? 3 : 0);
    const bool is_near = near.holds_near(triangle, within, marker);
    ASSERT_EQ(is_near, NearLines(graph, poller).holds_near(triangle, within, marker)) << i;
    yes += is_near;
  }
  EXPECT_GT(yes, 1000);
  EXPECT_LT(yes, 19'000);
}

TEST(NearLines, BoundsTheFarthestPoint) {
  const ExecutionContext context;
  StopPoller poller(context);
  const NearLines near(one_line(), poller);
  EXPECT_NEAR(near.farthest({2, 0.5}, {4, 0.8}, 1), 0.8, 0.0625);
  EXPECT_GE(near.farthest({2, 0.5}, {4, 0.8}, 1), 0.8);
  EXPECT_EQ(near.farthest({2, 0}, {4, 0}, 0), 0);
}

}  // namespace
}  // namespace weft
