// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/triangulation/hilbert.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <random>
#include <vector>

namespace weft {
namespace {

std::vector<std::uint32_t> order_of(const std::vector<Point>& points) {
  const ExecutionContext context;
  StopPoller poller(context);
  return hilbert_order(points, poller);
}

std::vector<Point> random_points(std::size_t n, double scale) {
  std::mt19937 random(3);
  std::vector<Point> points(n);
  for (Point& p : points) {
    p.x = scale * random();
    p.y = scale * random();
  }
  return points;
}

TEST(Hilbert, IsAPermutation) {
  for (const std::size_t n : {0, 1, 2, 63, 64, 65, 5000}) {
    std::vector<std::uint32_t> order = order_of(random_points(n, 1));
    ASSERT_EQ(order.size(), n);
    std::sort(order.begin(), order.end());
    for (std::uint32_t i = 0; i < n; ++i) ASSERT_EQ(order[i], i);
  }
}

TEST(Hilbert, StepsFromCellToNeighbourOnAGrid) {
  std::vector<Point> points;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) points.push_back({x * 1.0, y * 1.0});
  const std::vector<std::uint32_t> order = order_of(points);
  for (std::size_t k = 1; k < order.size(); ++k) {
    const Point p = points[order[k - 1]], q = points[order[k]];
    ASSERT_EQ(std::fabs(p.x - q.x) + std::fabs(p.y - q.y), 1) << k;
  }
}

TEST(Hilbert, KeepsTheOrderOfCoincidentPoints) {
  const std::vector<std::uint32_t> order = order_of(std::vector<Point>(200, Point{1, 2}));
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

TEST(Hilbert, OrdersFewAsAmongMany) {
  std::vector<Point> points = random_points(70'000, 1);
  for (const double corner : {0.0, 0x1p32}) points.push_back({corner, corner});
  std::rotate(points.begin(), points.end() - 2, points.end());  // few have the box of many
  const std::vector<std::uint32_t> all = order_of(points);
  for (const std::uint32_t n : {10u, 511u, 512u, 5000u}) {
    std::vector<std::uint32_t> among;
    std::copy_if(all.begin(), all.end(), std::back_inserter(among),
                 [n](std::uint32_t i) { return i < n; });
    EXPECT_EQ(order_of({points.begin(), points.begin() + n}), among) << n;
  }
}

TEST(Hilbert, OrdersACrowdAsIfNothingWereFarAway) {
  for (const double scale : {1e-9, 1e-60, 1e-100}) {
    std::vector<Point> points = random_points(5000, scale);
    const std::vector<std::uint32_t> alone = order_of(points);
    points.push_back({1e50, 1e50});
    points.push_back({1e10, 1e10});
    std::vector<std::uint32_t> order = order_of(points);
    order.erase(std::remove_if(order.begin(), order.end(), [](auto i) { return i >= 5000; }),
                order.end());
    EXPECT_EQ(order, alone) << scale;
  }
}

TEST(Hilbert, TakesPointsThatDoublesBarelyTellApart) {
  std::vector<Point> points(300);
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i].x = static_cast<double>(i) * std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(order_of(points).size(), 300u);
}

}  // namespace
}  // namespace weft
