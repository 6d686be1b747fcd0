// SPDX-License-Identifier: Apache-2.0
// Rules 6 and 7: angles and areas; small input angles are in exemption_test.cpp.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/checker/lattice.h"

namespace weft::check::testing {
namespace {

using Rules = std::set<Rule>;

constexpr double kSmallestAngle = 53.13010235415598;  // atan2(4, 3)
constexpr double kLargestAngle = 63.43494882292201;   // atan2(2, 1)

TEST(Quality, MeasuresAnglesAndArea) {
  const Report report = block(4).check();
  EXPECT_NEAR(report.facts.min_angle_deg, kSmallestAngle, 1e-12);
  EXPECT_NEAR(report.facts.max_angle_deg, kLargestAngle, 1e-12);
  EXPECT_EQ(report.facts.area, 16);
  EXPECT_EQ(report.facts.triangles, 32u);
  EXPECT_EQ(report.facts.vertices, 25u);
  EXPECT_EQ(report.facts.edges, 16u);
  ASSERT_TRUE(report.facts.worst_area_ratio);
  EXPECT_EQ(*report.facts.worst_area_ratio, 1);
  ASSERT_TRUE(report.facts.ideal_ratio);
  EXPECT_NEAR(*report.facts.ideal_ratio, 1, 1e-12);
  // Squared edges of 1, 5/4 and 5/4.
  EXPECT_NEAR(report.facts.mean_quality, 4 * std::sqrt(3.0) * 0.5 / 3.5, 1e-12);
  EXPECT_NEAR(report.facts.min_angle_p1_deg, kSmallestAngle, 1e-12);
}

TEST(Quality, WithoutBoundsThereIsNoRatio) {
  Problem problem = block(2);
  problem.requirements = {};
  EXPECT_FALSE(problem.check().facts.worst_area_ratio);
  EXPECT_FALSE(problem.check().facts.ideal_ratio);
}

TEST(Angle, ASmallAngleIsAViolation) {
  Problem problem = block(2);
  problem.requirements.min_angle_deg = 54;
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kAngle});
  EXPECT_EQ(report.facts.unrefined, report.total(Rule::kAngle));
}

TEST(Angle, TheBoundHasItsTolerance) {
  Problem problem = block(2);
  problem.requirements.min_angle_deg = kSmallestAngle + 0.9e-7;
  EXPECT_TRUE(problem.check().ok());
  problem.requirements.min_angle_deg = kSmallestAngle + 1.1e-7;
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kAngle});
}

TEST(Angle, AMovedVertexMakesASmallOne) {
  Problem problem = block(4);
  problem.requirements.max_area = std::nullopt;
  Vec2& p = problem.mesh.vertices[vertex(problem.mesh, Lattice::at({2, 2}))];
  p.x += 0.01;
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kAngle});
}

TEST(Area, ATriangleOverTheConstantIsAViolation) {
  Problem problem = block(2);
  problem.requirements.max_area = 0.5 * (1 - 1e-8);
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kArea});
  EXPECT_EQ(report.total(Rule::kArea), 8u);
}

TEST(Area, TheBoundHasItsTolerance) {
  Problem problem = block(2);
  problem.requirements.max_area = 0.5 * (1 - 1e-10);
  EXPECT_TRUE(problem.check().ok());
}

TEST(Area, TheSizeExpressionBoundsItAtTheCentroid) {
  Problem problem = block(4);
  // Centroids of the lower row are at y = 1/3 and 2/3.
  problem.requirements.size = "y < 1 ? 0.4 : 0.5";
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kArea});
  EXPECT_EQ(report.total(Rule::kArea), 8u);
  problem.requirements.size = "y < 0.3 ? 0.4 : 0.5";
  EXPECT_TRUE(problem.check().ok());
}

TEST(Area, AJumpOfTheSizeAtTheCentroidItselfIsForgiven) {
  Problem problem = block(1);
  // The first centroid is at (1/2, 1/3), and 1/3 is no double.
  problem.requirements.size = "y > 1/3 ? 0.5 : 0.4";
  EXPECT_TRUE(problem.check().ok());
  problem.requirements.size = "y > 0.333334 ? 0.5 : 0.4";
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kArea});
}

TEST(Area, ConstantAndExpressionHoldTogether) {
  Problem problem = block(1);
  problem.requirements.size = "1";
  EXPECT_TRUE(problem.check().ok());
  problem.requirements.max_area = 0.1;
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kArea});
}

TEST(CheckersSize, AnExpressionThatDoesNotParseIsAViolation) {
  Problem problem = block(2);
  problem.requirements.size = "1 +";
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kSize});
}

TEST(CheckersSize, AValueThatIsNotPositiveAndFiniteIsAViolation) {
  for (const char* source : {"0", "-1", "1/0", "sqrt(-1)", "x > 1 ? 1 : -1"}) {
    Problem problem = block(2);
    problem.requirements.size = source;
    EXPECT_EQ(violated(problem.check()), Rules{Rule::kSize}) << source;
  }
}

TEST(Lengths, OfEdgesWithAMarkerAreBoundByTheSizeAtIt) {
  Problem problem = block(4);  // edges of 1 and sqrt(5/4)
  SizeAt at{problem.mesh.edges[0].marker, std::sqrt(1.25)};
  problem.requirements.size.at = {at};
  EXPECT_TRUE(problem.check().ok()) << to_text(problem.check());
  problem.requirements.size.at[0].max_edge *= 1 - 1e-8;
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kLengths});
  EXPECT_NE(to_text(report).find("1.118033988749895 long, the size at marker"), std::string::npos)
      << to_text(report);
  problem.requirements.size.at[0].marker += 100;
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kSize});
}

TEST(Lengths, GrowByTheGradationFromSegmentsWithASizeAtTheirMarker) {
  Problem problem = block(4);  // triangles of area 0.5
  problem.requirements = {};
  problem.requirements.size.at = {{problem.mesh.edges[0].marker, 1}};
  problem.requirements.size.gradation = 1;  // 0.43 on the segments, 0.77 at the distance 1/3
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kLengths});
  problem.requirements.size.gradation = 0.2;  // 0.49
  EXPECT_EQ(violated(problem.check()), (Rules{Rule::kArea, Rule::kLengths}));
}

TEST(Area, GrowsByTheGradationFromRegionsWithABoundOfTheirOwn) {
  Problem problem = block_with_regions();  // triangles of area 0.5
  problem.requirements = {};
  problem.domain.regions[0].max_area = 0.49;
  EXPECT_EQ(problem.check().total(Rule::kArea), 36u);
  for (const SizeSpec::Value& value : {SizeSpec::Value(), SizeSpec::Value(10.0)}) {
    problem.requirements.size.value = value;
    // 0.5 about 0.02 from the nearest centroid, and beyond the region from 0.17.
    problem.requirements.size.gradation = 0.5;
    EXPECT_EQ(problem.check().total(Rule::kArea), 36u);
    // Those of the region alone have 0.98; the bounds of the others are larger.
    EXPECT_GT(problem.check().facts.ideal_ratio, 1);
    problem.requirements.size.gradation = 0.01;
    EXPECT_GT(problem.check().total(Rule::kArea), 36u);
    EXPECT_LT(problem.check().total(Rule::kArea), 72u);
  }
}

TEST(Unrefined, AsManyAsAreAllowedAreNoViolation) {
  Problem problem = block(2);
  problem.requirements.max_area = 0.4;
  problem.requirements.min_angle_deg = 60;
  problem.requirements.allowed_unrefined = 8;
  Report report = problem.check();
  EXPECT_TRUE(report.ok()) << to_text(report);
  EXPECT_EQ(report.facts.unrefined, 8u);
  ASSERT_TRUE(report.facts.first_unrefined);
  EXPECT_NE(to_text(report).find("unrefined 8, the first at ("), std::string::npos);
  problem.requirements.allowed_unrefined = 7;
  report = problem.check();
  EXPECT_EQ(violated(report), (Rules{Rule::kAngle, Rule::kArea}));
  EXPECT_EQ(report.total(Rule::kArea), 8u);
}

TEST(Area, OfARasterIsBoundAtTheCentroids) {
  Problem problem = block(4);  // triangles of area 0.5 on [0, 4] x [0, 4]
  problem.requirements = {};
  Raster raster{{0, 0}, 4, 4, 2, 2, {0.5, 0.5, 0.5, 0.5}};
  problem.requirements.size = raster;
  EXPECT_TRUE(problem.check().ok());
  raster.values[1] = 0.4;
  problem.requirements.size = raster;
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kArea});
  raster.values = {0.5, 0, 0.5, -1};
  problem.requirements.size = raster;
  EXPECT_TRUE(violated(problem.check()).contains(Rule::kSize));
}

}  // namespace
}  // namespace weft::check::testing
