// SPDX-License-Identifier: Apache-2.0
// Vertices that rounding has put beside their segments.
#include <gtest/gtest.h>

#include <cmath>

#include "checker/domain/gaps.h"
#include "tests/checker/lattice.h"

namespace weft::check::testing {
namespace {

using Rules = std::set<Rule>;

// The block, turned and moved: nothing is exactly on anything any more.
Vec2 turn(Vec2 p) {
  const double c = std::cos(0.3), s = std::sin(0.3);
  return {7 + c * p.x - s * p.y, 3 + s * p.x + c * p.y};
}

Problem turned(Problem problem) {
  for (Vec2& p : problem.domain.points) p = turn(p);
  for (Vec2& p : problem.domain.holes) p = turn(p);
  for (RegionSeed& seed : problem.domain.regions) seed.at = turn(seed.at);
  for (Vec2& p : problem.mesh.vertices) p = turn(p);
  problem.requirements.max_area = 0.5 + 1e-9;
  return problem;
}

TEST(Rounding, OfSteinerPointsOnSegmentsIsTolerated) {
  for (const Problem& problem : {block(8), block_with_hole(), block_with_regions()}) {
    const Report report = turned(problem).check();
    EXPECT_TRUE(report.ok()) << to_text(report);
  }
}

TEST(Rounding, OfManyUnitsIsNot) {
  Problem problem = turned(block(4));
  Vec2& p = problem.mesh.vertices[vertex(problem.mesh, turn(Lattice::at({2, 0})))];
  p.y -= 1e-13;
  EXPECT_TRUE(violated(problem.check()).contains(Rule::kChains));
}

TEST(Rounding, OfACrossingIsTolerated) {
  // Two lines through (1/3, 1/3), and the mesh of the eight points around and there.
  Problem problem;
  problem.domain.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0.5}};
  problem.domain.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 2}, {4, 1}};
  problem.mesh.vertices = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0.5}, {1.0 / 3, 1.0 / 3}};
  problem.mesh.triangles = {{0, 1, 5}, {1, 2, 5}, {2, 3, 5}, {3, 4, 5}, {4, 0, 5}};
  problem.mesh.edges = {{0, 1, 0}, {1, 2, 0}, {2, 3, 0}, {3, 4, 0}, {4, 0, 0},
                        {0, 5, 0}, {5, 2, 0}, {4, 5, 0}, {5, 1, 0}};
  Report report = problem.check();
  EXPECT_TRUE(report.ok()) << to_text(report);
  problem.mesh.vertices[5].x += 1e-12;
  report = problem.check();
  EXPECT_TRUE(violated(report).contains(Rule::kChains)) << to_text(report);
}

TEST(Rounding, LetsSegmentsAlmostOnEachOtherShareAChain) {
  // A line along y = 3, and one that crosses it between two vertices, units in the last place away.
  Problem problem = Lattice(6)
                        .box({0, 0}, {6, 6}, 1)
                        .segment({2, 3}, {4, 3}, 5)
                        .segment({1, 3}, {5, 3}, 6)
                        .build([](Lattice::Node) { return true; });
  const double unit = 0x1p-51;
  for (std::vector<Vec2>* points : {&problem.domain.points, &problem.mesh.vertices}) {
    for (Vec2& p : *points) {
      if (p == Lattice::at({1, 3})) p.y += unit;
      if (p == Lattice::at({5, 3})) p.y -= 2 * unit;
    }
  }
  // Both lines list the edges that they share; a mesh lists them once.
  std::set<std::set<std::uint32_t>> seen;
  std::erase_if(problem.mesh.edges, [&](const Mesh::Edge& e) {
    return !seen.insert({e.a, e.b}).second;
  });
  const Report report = problem.check();
  EXPECT_TRUE(report.ok()) << to_text(report);
  problem.mesh.edges.back().marker = 7;
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kMarkers});
}

TEST(Rounding, DoesNotHideASegmentThatLeavesTheDomainUnmeshed) {
  // Through the inside and out over a side, where the mesh knows nothing of it.
  Problem problem = block(4);
  problem.domain.points.push_back({7, 3.7});
  problem.domain.segments.push_back({0, 4});
  problem.domain.markers.push_back(0);
  const Report report = problem.check();
  EXPECT_EQ(violated(report), (Rules{Rule::kChains, Rule::kCoverage}));
  EXPECT_NE(to_text(report).find("no vertex where it meets others"), std::string::npos)
      << to_text(report);
}

TEST(Gaps, ALineThatStopsAnUlpShortOfASegmentDivides) {
  // The side from (0, 0) to (3, 1); p is a double as near to it as can be, but not on it.
  Problem problem;
  Domain& domain = problem.domain;
  const Vec2 exact{0.3, 0.1};
  for (int ulps = -2; ulps <= 2; ++ulps) {
    Vec2 p = exact;
    for (int k = 0; k < std::abs(ulps); ++k) p.y = std::nextafter(p.y, ulps > 0 ? 1 : -1);
    domain.points = {{0, 0}, {3, 1}, {0, 1}, p};
    domain.segments = {{0, 1}, {1, 2}, {2, 0}, {2, 3}};
    domain.regions = {{{0.1, 0.2}, 1, std::nullopt}, {{1, 0.8}, 2, std::nullopt}};
    problem.mesh.vertices = domain.points;
    problem.mesh.triangles = {{0, 3, 2}, {3, 1, 2}};
    problem.mesh.regions = {1, 2};
    problem.mesh.edges = {{0, 3, 0}, {3, 1, 0}, {1, 2, 0}, {2, 0, 0}, {2, 3, 0}};
    const Report report = problem.check();
    EXPECT_TRUE(report.ok()) << ulps << "\n" << to_text(report);
    problem.mesh.regions = {2, 2};
    EXPECT_EQ(violated(problem.check()), Rules{Rule::kRegions}) << ulps;
  }
}

// A needle with its tip at (0, 1 + height), and the mesh of its part below the point (0, 1), which
// lies on its right side.
Problem needle(double width, double height) {
  Problem problem;
  problem.domain.points = {{-width, 0}, {0, 0}, {0, 1 + height}, {0, 1}};
  problem.domain.segments = {{0, 1}, {1, 2}, {2, 0}};
  problem.mesh.vertices = {{-width, 0}, {0, 0}, {0, 1}};
  problem.mesh.triangles = {{0, 1, 2}};
  problem.mesh.edges = {{0, 1, 0}, {1, 2, 0}, {2, 0, 0}};
  return problem;
}

TEST(Gaps, APointWithinRoundingOfBothSidesClosesATip) {
  const Report report = needle(1e-9, 1e-7).check();
  EXPECT_TRUE(report.ok()) << to_text(report);
  EXPECT_TRUE(violated(needle(1e-3, 1e-7).check()).contains(Rule::kPoints)) << "1e-10 beside one";
}

TEST(Gaps, ALineThatStopsVisiblyShortDoesNot) {
  Domain domain;
  domain.points = {{0, 0}, {3, 1}, {0, 1}, {0.3, 0.1 + 1e-14}};
  domain.segments = {{0, 1}, {1, 2}, {2, 0}, {2, 3}};
  EXPECT_TRUE(links_across_gaps(domain).empty());
}

TEST(Gaps, AnEndExactlyOnASegmentNeedsNoLink) {
  Domain domain;
  domain.points = {{0, 0}, {4, 2}, {2, 1}, {0, 5}};
  domain.segments = {{0, 1}, {3, 2}};
  EXPECT_TRUE(links_across_gaps(domain).empty());
}

}  // namespace
}  // namespace weft::check::testing
