// SPDX-License-Identifier: Apache-2.0
#include "checker/size/gradation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/checker/lattice.h"

namespace weft::check::testing {
namespace {

using Rules = std::set<Rule>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(GradationLimit, OfASpotIsACone) {
  const GradationLimit limit({{0, 0}, {10, 0}}, {area_of_edge(1), area_of_edge(100)}, 0.5);
  for (const double x : {0.0, 1.0, 4.0, 10.0, 30.0})
    EXPECT_NEAR(limit({x, 0}, area_of_edge(100)), area_of_edge(1 + 0.5 * x), 1e-12 * (1 + x * x));
  EXPECT_EQ(limit({4, 0}, 0.1), 0.1);
  EXPECT_EQ(limit({4, 0}, kInfinity), limit({4, 0}, 1e6));
}

TEST(GradationLimit, IsTheLeastOfAllSamples) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> place(0, 1);
  for (const double gradation : {0.01, 0.3, 5.0}) {
    std::vector<Vec2> points;
    std::vector<double> areas;
    for (int i = 0; i < 500; ++i) {
      points.push_back({place(random), place(random)});
      areas.push_back(std::pow(place(random), 4));
    }
    const GradationLimit limit(points, areas, gradation);
    for (int k = 0; k < 500; ++k) {
      const Vec2 p{place(random), place(random)};
      const double area = place(random);
      double edge = edge_of_area(area);
      for (std::size_t i = 0; i < points.size(); ++i)
        edge = std::min(edge, edge_of_area(areas[i]) +
                                  gradation * std::hypot(p.x - points[i].x, p.y - points[i].y));
      EXPECT_NEAR(limit(p, area), area_of_edge(edge), 1e-12);
    }
  }
}

TEST(GradationLimit, TakesNoSampleFromWhatIsNoSize) {
  const GradationLimit limit({{0, 0}, {1, 0}, {2, 0}, {3, 0}}, {kNan, -1, kInfinity, 1}, 1);
  EXPECT_NEAR(limit({0, 0}, 1000), area_of_edge(edge_of_area(1) + 3), 1e-12);
  EXPECT_EQ(GradationLimit({}, {}, 1)({0, 0}, 3), 3);
}

// The size is small at one vertex alone, the corner of one triangle, so that nothing but the limit
// asks for smaller triangles.
TEST(Gradation, BrokenByOnePercentInOneTriangleIsFound) {
  Problem problem = block(8);
  problem.requirements = {};
  const double to_centroid = std::hypot(0.5, 1.0 / 3);  // triangles of area 0.5
  const auto spot = [&](double factor) {
    const double edge = factor * (edge_of_area(0.5) - 0.5 * to_centroid);
    SizeSpec size = "x == 0 && y == 0 ? " + std::to_string(edge) + " : 100";
    size.measure = Measure::kEdge;
    size.gradation = 0.5;
    return size;
  };
  for (const bool within : {false, true}) {
    problem.requirements.size = spot(1.0001);
    problem.requirements.size.gradation_within = within;
    EXPECT_TRUE(problem.check().ok()) << to_text(problem.check());
    problem.requirements.size = spot(0.98);
    problem.requirements.size.gradation_within = within;
    const Report report = problem.check();
    EXPECT_EQ(violated(report), Rules{Rule::kArea});
    EXPECT_EQ(report.total(Rule::kArea), 1u);
    EXPECT_EQ(report.facts.first_unrefined_at, (Vec2{0.5, 1.0 / 3}));
    EXPECT_NE(to_text(report).find("because sizes grow by at most 0.5"), std::string::npos);
  }
  problem.requirements.size.gradation = 0;
  EXPECT_TRUE(problem.check().ok());
}

TEST(Gradation, OfASizeThatGrowsLessChangesNothing) {
  Problem problem = block(8);
  problem.requirements = {};
  problem.requirements.size = "1.08 + 0.2*hypot(x, y)";
  problem.requirements.size.measure = Measure::kEdge;
  const Report without = problem.check();
  problem.requirements.size.gradation = 0.2001;
  const Report with = problem.check();
  EXPECT_TRUE(with.ok()) << to_text(with);
  EXPECT_NEAR(*with.facts.ideal_ratio, *without.facts.ideal_ratio, 1e-12);
  problem.requirements.size = "0.9 + 0.2*hypot(x, y)";
  problem.requirements.size.measure = Measure::kEdge;
  problem.requirements.allowed_unrefined = 1;  // the one at the origin
  EXPECT_TRUE(problem.check().ok());
  problem.requirements.size.gradation = 0.05;
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kArea});
}

TEST(Gradation, IsOfEdgesAlsoIfTheSizeIsAnArea) {
  Problem problem = block(8);
  problem.requirements = {};
  problem.requirements.size = "x == 0 && y == 0 ? 0.01 : 100";
  problem.requirements.size.gradation = 0.5;
  const double at_centroid = edge_of_area(0.01) + 0.5 * std::hypot(0.5, 1.0 / 3);
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kArea});
  EXPECT_NEAR(*report.facts.worst_area_ratio, 0.5 / area_of_edge(at_centroid), 1e-9);
}

TEST(Gradation, ThatIsNoneIsAViolation) {
  for (const double gradation : {-1.0, kNan, kInfinity}) {
    Problem problem = block(2);
    problem.requirements.size = "1";
    problem.requirements.size.gradation = gradation;
    EXPECT_EQ(violated(problem.check()), Rules{Rule::kSize}) << gradation;
  }
}

}  // namespace
}  // namespace weft::check::testing
