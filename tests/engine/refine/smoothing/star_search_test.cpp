// SPDX-License-Identifier: Apache-2.0
// Where a vertex should go in its star.
#include "engine/refine/smoothing/star_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "engine/base/geometry.h"

namespace weft {
namespace {

constexpr double kNoBound = std::numeric_limits<double>::infinity();

// A polygon of unit radius around `centre`, the vertex being at the origin.
std::vector<Point> polygon(std::uint32_t edges, Point centre) {
  std::vector<Point> link;
  for (std::uint32_t i = 0; i < edges; ++i) {
    const double angle = 2 * std::numbers::pi * i / edges;
    link.push_back({centre.x + std::cos(angle), centre.y + std::sin(angle)});
  }
  return link;
}

StarSearch::Place search(const std::vector<Point>& link, const std::vector<double>& bounds,
                         double scale = 1) {
  StarSearch star;
  const auto size = static_cast<std::uint32_t>(link.size());
  star.begin(size, scale);
  for (std::uint32_t i = 0; i <= size; ++i)
    star.set_point(i, scale * link[i % size].x, scale * link[i % size].y);
  for (std::uint32_t i = 0; i < size; ++i) star.set_bound(i, scale * scale * bounds[i]);
  return star.search();
}

StarSearch::Place search(const std::vector<Point>& link) {
  return search(link, std::vector<double>(link.size(), kNoBound));
}

std::vector<double> areas(const std::vector<Point>& link, Point p) {
  std::vector<double> areas;
  for (std::size_t i = 0; i < link.size(); ++i) {
    const Point a = link[i];
    const Point b = link[(i + 1) % link.size()];
    areas.push_back(0.5 * ((a.x - p.x) * (b.y - p.y) - (a.y - p.y) * (b.x - p.x)));
  }
  return areas;
}

double smallest_angle(const std::vector<Point>& link, Point p) {
  double smallest = 180;
  for (std::size_t i = 0; i < link.size(); ++i) {
    const std::array<Point, 3> corners{p, link[i], link[(i + 1) % link.size()]};
    for (std::size_t k = 0; k < 3; ++k) {
      const Point a = corners[k];
      const Point b = corners[(k + 1) % 3];
      const Point c = corners[(k + 2) % 3];
      const double cross = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
      const double dot = (b.x - a.x) * (c.x - a.x) + (b.y - a.y) * (c.y - a.y);
      smallest = std::min(smallest, std::atan2(cross, dot) * 180 / std::numbers::pi);
    }
  }
  return smallest;
}

TEST(StarSearch, FindsTheMiddleOfRegularPolygons) {
  for (const std::uint32_t edges : {5u, 6u, 7u}) {
    const Point middle{0.35, -0.2};
    const std::vector<Point> link = polygon(edges, middle);
    const StarSearch::Place place = search(link);
    EXPECT_GT(place.gain, 1.5) << edges;
    const double after = smallest_angle(link, {place.x, place.y});
    EXPECT_GT(after, std::min(47.0, smallest_angle(link, middle) - 2)) << edges;
  }
}

TEST(StarSearch, GivesTheGainInSquaredSines) {
  const std::vector<Point> link = polygon(6, {0.3, 0.1});
  const StarSearch::Place place = search(link);
  const auto sine = [](double degrees) { return std::sin(degrees * std::numbers::pi / 180); };
  const double before = sine(smallest_angle(link, {0, 0}));
  const double after = sine(smallest_angle(link, {place.x, place.y}));
  EXPECT_NEAR(place.gain, after * after / (before * before), 1e-3);
}

TEST(StarSearch, LeavesAVertexThatIsGoodEnough) {
  const StarSearch::Place place = search(polygon(6, {0.01, 0.02}));
  EXPECT_EQ(place.gain, 0);
  EXPECT_EQ(place.x, 0);
  EXPECT_EQ(place.y, 0);
}

TEST(StarSearch, LeavesAVertexThatSeesAFlatTriangle) {
  EXPECT_EQ(search({{1, 0}, {0, 1}, {-1, 0}}).gain, 0);
}

TEST(StarSearch, MakesNoTriangleLargerThanItsBound) {
  const std::vector<Point> link = polygon(6, {0.4, 0});
  std::vector<double> bounds = areas(link, {0, 0});
  for (double& bound : bounds) bound += 0.05;
  const auto holds = [&](const StarSearch::Place& place) {
    const std::vector<double> after = areas(link, {place.x, place.y});
    return std::equal(after.begin(), after.end(), bounds.begin(),
                      [](double area, double bound) { return area <= bound + 1e-6; });
  };
  EXPECT_FALSE(holds(search(link)));
  EXPECT_TRUE(holds(search(link, bounds)));
  EXPECT_GT(search(link, bounds).gain, 1);
}

TEST(StarSearch, LeavesAVertexWhoseTrianglesAreTooLarge) {
  const std::vector<Point> link = polygon(6, {0.4, 0});
  EXPECT_EQ(search(link, std::vector<double>(6, 0.3)).gain, 0);
}

TEST(StarSearch, FindsTheSameAtEveryScale) {
  const std::vector<Point> link = polygon(7, {0.2, 0.3});
  const std::vector<double> bounds(7, 0.6);
  const StarSearch::Place expected = search(link, bounds);
  for (const int exponent : {-300, -40, 40, 300}) {
    const double scale = std::ldexp(1.0, exponent);
    const StarSearch::Place place = search(link, bounds, scale);
    EXPECT_EQ(place.gain, expected.gain) << exponent;
    EXPECT_EQ(place.x, scale * expected.x) << exponent;
    EXPECT_EQ(place.y, scale * expected.y) << exponent;
  }
}

}  // namespace
}  // namespace weft
