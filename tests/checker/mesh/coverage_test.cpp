// SPDX-License-Identifier: Apache-2.0
// Rule 4: the domain, all of it and nothing else; regions.
#include <gtest/gtest.h>

#include "tests/checker/lattice.h"

namespace weft::check::testing {
namespace {

using Rules = std::set<Rule>;

TEST(Coverage, AHoleThatIsCoveredIsAViolation) {
  Problem problem = block_with_hole();
  Problem full = Lattice(6).box({0, 0}, {6, 6}, 1).box({2, 2}, {4, 4}, 2).build([](Lattice::Node) {
    return true;
  });
  problem.mesh = full.mesh;
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kCoverage});
  EXPECT_NE(report.violations[0].sentence.find("in a hole"), std::string::npos);
  EXPECT_TRUE(full.check().ok());
}

TEST(Coverage, AHoleThatWasNotAskedForIsAViolation) {
  Problem problem = block_with_hole();
  problem.domain.holes.clear();
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kCoverage});
}

TEST(Coverage, TrianglesOutsideAreAViolation) {
  Problem problem = block(3);
  Mesh& mesh = problem.mesh;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {{10, 0}, {11, 0}, {10.5, 0.9}});
  mesh.triangles.push_back({first, first + 1, first + 2});
  for (std::uint32_t i = 0; i < 3; ++i) mesh.edges.push_back({first + i, first + (i + 1) % 3, 0});
  EXPECT_EQ(violated(problem.check()), (Rules{Rule::kEdges, Rule::kCoverage}));
}

TEST(Coverage, AMissingInnerTriangleIsAViolation) {
  Problem problem = block(4);
  remove_triangle(problem.mesh, triangle(problem.mesh, Lattice::at({1, 1}), Lattice::at({2, 1}),
                                         Lattice::at({1, 2})));
  const Report report = problem.check();
  EXPECT_EQ(violated(report), (Rules{Rule::kEdges, Rule::kCoverage}));
  EXPECT_EQ(report.total(Rule::kEdges), 3u);
}

TEST(Coverage, AMissingComponentIsAViolation) {
  Problem problem = Lattice(8).box({0, 0}, {3, 3}).box({5, 5}, {8, 8}).build([](Lattice::Node c) {
    return c[0] < 3 && c[1] < 3;
  });
  const std::set<Rule> rules = violated(problem.check());
  EXPECT_TRUE(rules.contains(Rule::kCoverage));
  EXPECT_TRUE(rules.contains(Rule::kPoints));
}

TEST(Coverage, AMeshOfAnotherDomainIsAViolation) {
  Problem problem = block(3);
  problem.domain = block(4).domain;
  EXPECT_TRUE(violated(problem.check()).contains(Rule::kCoverage));
}

TEST(Coverage, ADomainWithoutSegmentsHasNoMesh) {
  Problem problem = block(3);
  problem.domain = {};
  EXPECT_EQ(violated(problem.check()), (Rules{Rule::kEdges, Rule::kCoverage}));
}

TEST(Coverage, EvenOddLeavesARingsInsideOut) {
  Problem problem = block_with_hole();
  problem.domain.fill = Fill::kEvenOdd;
  problem.domain.holes.clear();
  EXPECT_TRUE(problem.check().ok()) << to_text(problem.check());
  problem.domain.fill = Fill::kSeeds;
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kCoverage});
}

TEST(Regions, AWrongIdIsAViolation) {
  Problem problem = block_with_regions();
  problem.mesh.regions[3] = 20;
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kRegions});
  EXPECT_EQ(report.total(Rule::kRegions), 1u);
}

TEST(Regions, NoIdsMeanZero) {
  Problem problem = block_with_regions();
  problem.mesh.regions.clear();
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kRegions});
  EXPECT_EQ(problem.check().total(Rule::kRegions), 72u);
  problem.domain.regions.clear();
  EXPECT_TRUE(problem.check().ok());
}

TEST(Regions, AnIdWhereNoSeedIsIsAViolation) {
  Problem problem = block(3);
  problem.mesh.regions.assign(problem.mesh.triangles.size(), 0);
  EXPECT_TRUE(problem.check().ok());
  problem.mesh.regions[0] = 1;
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kRegions});
}

TEST(Regions, ASeedInAHoleIsNoRegion) {
  Problem problem = block_with_hole();
  problem.domain.regions = {{problem.domain.holes[0], 5, 0.001}};
  EXPECT_TRUE(problem.check().ok());
}

TEST(Regions, TheirAreaBoundHolds) {
  Problem problem = block_with_regions();
  problem.domain.regions[1].max_area = 0.5;
  EXPECT_TRUE(problem.check().ok());
  problem.domain.regions[1].max_area = 0.49;
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kArea});
  EXPECT_EQ(report.total(Rule::kArea), 36u);
}

TEST(DomainRules, ASeedOnASegmentCannotBeJudged) {
  Problem problem = block(3);
  problem.domain.holes = {{1.5, 0}};
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kDomain});
  EXPECT_EQ(report.violations[0].sentence,
            "hole seed 0 at (1.5, 0) lies on segment 0: its face is ambiguous");
  EXPECT_FALSE(report.not_judged.empty());
}

}  // namespace
}  // namespace weft::check::testing
