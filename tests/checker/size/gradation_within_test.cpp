// SPDX-License-Identifier: Apache-2.0
#include "checker/size/gradation_within.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "checker/size/gradation.h"
#include "tests/checker/lattice.h"

namespace weft::check::testing {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Two arms of a U, x < 3 and x > 5, above y = 1, of squares with sides of 1 cut in two.
struct UShape {
  UShape() {
    const auto vertex = [](int x, int y) { return static_cast<std::uint32_t>(9 * y + x); };
    for (int y = 0; y <= 8; ++y)
      for (int x = 0; x <= 8; ++x)
        mesh.vertices.push_back({static_cast<double>(x), static_cast<double>(y)});
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) {
        if (y >= 1 && x >= 3 && x < 5) continue;
        mesh.triangles.push_back({vertex(x, y), vertex(x + 1, y), vertex(x + 1, y + 1)});
        mesh.triangles.push_back({vertex(x, y), vertex(x + 1, y + 1), vertex(x, y + 1)});
      }
    areas.assign(mesh.vertices.size() + mesh.triangles.size(), kInfinity);
    areas[vertex(3, 8)] = area_of_edge(0.1);
  }
  Mesh mesh;
  std::vector<double> areas;
};

TEST(GradationWithin, OfASpotGrowsAroundTheBend) {
  const UShape u;
  const GradationWithin limit(u.mesh, u.areas, 0.5);
  const auto edge = [&](double x, double y) { return edge_of_area(limit({x, y}, 1e6)); };
  EXPECT_NEAR(edge(3, 4), 0.1 + 0.5 * 4, 1e-12);
  EXPECT_NEAR(edge(3, 1), 0.1 + 0.5 * 7, 1e-12);
  EXPECT_NEAR(edge(5, 1), 0.1 + 0.5 * 9, 1e-12);
  EXPECT_NEAR(edge(5, 8), 0.1 + 0.5 * 16, 1e-12);
  EXPECT_NEAR(edge(5 + 2. / 3, 7 + 2. / 3), 0.1 + 0.5 * (15 + std::sqrt(8. / 9)), 1e-12);
  EXPECT_EQ(limit({5, 8}, 0.3), 0.3);
}

TEST(GradationWithin, IsNowhereBelowTheStraightOne) {
  UShape u;
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> place(0, 1);
  std::vector<Vec2> points = u.mesh.vertices;
  for (const auto& [a, b, c] : u.mesh.triangles)
    points.push_back({(points[a].x + points[b].x + points[c].x) / 3,
                      (points[a].y + points[b].y + points[c].y) / 3});
  for (double& area : u.areas) area = std::pow(place(random), -2);
  const GradationWithin within(u.mesh, u.areas, 0.3);
  const GradationLimit straight(points, u.areas, 0.3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_GE(within(points[i], 1e6), straight(points[i], 1e6) * (1 - 1e-12));
    EXPECT_LE(within(points[i], 1e6), 1e6);
  }
}

TEST(GradationWithin, TakesNoSampleFromWhatIsNoSize) {
  UShape u;
  u.areas.assign(u.areas.size(), kNan);
  EXPECT_EQ(GradationWithin(u.mesh, u.areas, 1)({1, 1}, 7), 7);
}

}  // namespace
}  // namespace weft::check::testing
