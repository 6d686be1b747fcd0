// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/interior_point.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace weft::files {
namespace {

void add_ring(Domain& domain, const std::vector<Point>& ring) {
  const auto first = static_cast<std::uint32_t>(domain.points.size());
  domain.points.insert(domain.points.end(), ring.begin(), ring.end());
  for (std::uint32_t i = 0; i < ring.size(); ++i)
    domain.segments.push_back(
        {first + i, first + (i + 1) % static_cast<std::uint32_t>(ring.size()), 0});
}

bool inside(const Domain& domain, PolygonRange range, Point p) {
  bool in = false;
  for (std::size_t s = range.first_segment; s < range.end_segment; ++s) {
    const Point a = domain.points[domain.segments[s].a];
    const Point b = domain.points[domain.segments[s].b];
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) in = !in;
  }
  return in;
}

TEST(InteriorPoint, LiesInsideRandomStars) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> radius(0.2, 1);
  Domain domain;
  std::vector<PolygonRange> ranges;
  for (int k = 0; k < 200; ++k) {
    std::vector<Point> ring;
    for (int i = 0; i < 30; ++i)
      ring.push_back({10.0 * k + radius(random) * std::cos(i * 0.2), radius(random) + i});
    const std::size_t first = domain.segments.size();
    add_ring(domain, ring);
    ranges.push_back({first, domain.segments.size()});
  }
  const auto points = interior_points(domain, ranges);
  ASSERT_TRUE(points);
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    ASSERT_TRUE((*points)[k]);
    EXPECT_TRUE(inside(domain, ranges[k], *(*points)[k])) << k;
  }
}

TEST(InteriorPoint, AvoidsTheHole) {
  Domain domain;
  add_ring(domain, {{0, 0}, {10, 0}, {10, 10}, {0, 10}});
  add_ring(domain, {{1, 1}, {1, 9}, {9, 9}, {9, 1}});
  const PolygonRange range{0, domain.segments.size()};
  const auto points = interior_points(domain, std::span(&range, 1));
  ASSERT_TRUE(points && (*points)[0]);
  EXPECT_TRUE(inside(domain, range, *(*points)[0]));
}

TEST(InteriorPoint, IsNoneWithoutArea) {
  Domain domain;
  add_ring(domain, {{0, 0}, {10, 0}, {5, 0}});
  const PolygonRange range{0, domain.segments.size()};
  const auto points = interior_points(domain, std::span(&range, 1));
  ASSERT_TRUE(points);
  EXPECT_FALSE((*points)[0]);
}

}  // namespace
}  // namespace weft::files
