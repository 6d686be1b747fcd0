// SPDX-License-Identifier: Apache-2.0
// Segments that are kept as they are.
#include "checker/mesh/kept.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "tests/checker/lattice.h"

namespace weft::check::testing {
namespace {

using Rules = std::set<Rule>;

// A strip of four cells. Its lower side is one segment with marker 5, its other sides are one for
// each edge.
Problem strip(bool is_split) {
  Lattice lattice(4);
  if (is_split) {
    lattice.segment({0, 0}, {4, 0}, 5);
  } else {
    for (int i = 0; i < 4; ++i) lattice.segment({i, 0}, {i + 1, 0}, 5);
  }
  lattice.segment({4, 0}, {4, 1}).segment({0, 1}, {0, 0});
  for (int i = 0; i < 4; ++i) lattice.segment({i, 1}, {i + 1, 1});
  return lattice.build([](Lattice::Node cell) { return cell[1] == 0; });
}

TEST(KeptSegments, AVertexInsideASegmentIsAViolation) {
  Problem problem = strip(true);
  EXPECT_TRUE(problem.check().ok()) << to_text(problem.check());
  problem.requirements.keep = {5};
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kKept});
  EXPECT_EQ(report.total(Rule::kKept), 3u);
  EXPECT_NE(to_text(report).find("lies on segment 0, which is kept"), std::string::npos)
      << to_text(report);
}

// A half disk whose arc, the first segment, becomes several: the number is that of the domain.
TEST(KeptSegments, HaveTheirNumbersBesideArcs) {
  Problem problem;
  problem.domain.points = {{1, 0}, {-1, 0}};
  problem.domain.segments = {{0, 1}, {1, 0}};
  problem.domain.arcs = {{0, 1}};
  const double half = std::sqrt(0.5);
  problem.mesh.vertices = {{1, 0}, {-1, 0}, {half, half}, {0, 1}, {-half, half}, {0, 0}};
  problem.mesh.triangles = {{5, 0, 2}, {5, 2, 3}, {5, 3, 4}, {5, 4, 1}};
  problem.mesh.regions = {0, 0, 0, 0};
  const double bulge = std::tan(std::numbers::pi / 16);
  problem.mesh.edges = {{0, 2}, {2, 3}, {3, 4}, {4, 1}, {1, 5}, {5, 0}};
  problem.mesh.bulges = {bulge, bulge, bulge, bulge, 0, 0};
  EXPECT_TRUE(problem.check().ok()) << to_text(problem.check());
  problem.requirements.keep.emplace();
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kKept}) << to_text(report);
  EXPECT_NE(to_text(report).find("vertex 5 at (0, 0) lies on segment 1, which is kept"),
            std::string::npos)
      << to_text(report);
}

TEST(KeptSegments, OfSegmentsWithoutMarkersToo) {
  Problem problem = strip(true);
  problem.requirements.keep.emplace();
  EXPECT_EQ(problem.check().total(Rule::kKept), 3u);
}

TEST(KeptSegments, OtherSegmentsMayBeSplit) {
  Problem problem = strip(true);
  problem.requirements.keep = {0, 4};
  EXPECT_TRUE(problem.check().ok());
}

TEST(KeptSegments, PointsOfTheDomainAreNoViolation) {
  Problem problem = strip(false);
  problem.requirements.keep = {5};
  EXPECT_TRUE(problem.check().ok());
}

TEST(KeptSegments, PlacesWhereSegmentsMeetAreNone) {
  Lattice lattice(2);
  lattice.box({0, 0}, {2, 2});
  lattice.segment({1, 0}, {1, 2}, 5).segment({0, 1}, {2, 1}, 5);
  Problem cross = lattice.build([](Lattice::Node) { return true; });
  cross.requirements.keep.emplace();
  EXPECT_TRUE(cross.check().ok()) << to_text(cross.check());
}

}  // namespace
}  // namespace weft::check::testing
