// SPDX-License-Identifier: Apache-2.0
// Rule 3: listed edges, chains, input points, markers.
#include <gtest/gtest.h>

#include "tests/checker/lattice.h"

namespace weft::check::testing {
namespace {

using Rules = std::set<Rule>;

Vec2 at(int i, int j) {
  return Lattice::at({i, j});
}

void drop_edge(Mesh& mesh, Vec2 p, Vec2 q) {
  mesh.edges.erase(mesh.edges.begin() + static_cast<std::ptrdiff_t>(listed_edge(mesh, p, q)));
}

TEST(Edges, AnUnlistedBoundaryEdgeIsAViolation) {
  Problem problem = block(3);
  drop_edge(problem.mesh, at(1, 0), at(2, 0));
  const Report report = problem.check();
  EXPECT_EQ(violated(report), (Rules{Rule::kEdges, Rule::kChains}));
  EXPECT_EQ(report.total(Rule::kEdges), 1u);
  EXPECT_EQ(report.total(Rule::kChains), 1u);
}

TEST(Edges, AListedEdgeThatTheMeshLacksIsAViolation) {
  Problem problem = block(3);
  problem.mesh.edges.push_back({vertex(problem.mesh, at(0, 0)), vertex(problem.mesh, at(3, 3)), 0});
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kEdges});
}

TEST(Edges, AnEdgeListedTwiceIsAViolation) {
  Problem problem = block(3);
  const Mesh::Edge edge = problem.mesh.edges[2];
  problem.mesh.edges.push_back({edge.b, edge.a, edge.marker});
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kEdges});
}

TEST(Edges, AListedEdgeOnNoSegmentIsAViolation) {
  Problem problem = block(3);
  problem.mesh.edges.push_back({vertex(problem.mesh, at(1, 1)), vertex(problem.mesh, at(2, 1)), 0});
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kEdges});
  EXPECT_NE(report.violations[0].sentence.find("is not part of a segment"), std::string::npos);
}

TEST(Edges, AnIndexOutOfRangeIsAViolation) {
  Problem problem = block(3);
  problem.mesh.edges[1].b = 4000000000u;
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kStructure});
}

TEST(Chains, AGapInAnInnerChainIsAViolation) {
  Problem problem = block_with_regions();
  drop_edge(problem.mesh, at(2, 3), at(3, 3));
  const Report report = problem.check();
  // The patches on its two sides are one now: neither face is covered as it should be.
  EXPECT_TRUE(violated(report).contains(Rule::kChains));
  EXPECT_FALSE(violated(report).contains(Rule::kEdges)) << to_text(report);
  EXPECT_NE(to_text(report).find("breaks off at vertex"), std::string::npos);
}

TEST(Chains, AGapInADanglingSegmentIsOnlyThat) {
  Problem problem =
      Lattice(6).box({0, 0}, {6, 6}).segment({1, 3}, {5, 3}, 3).build([](Lattice::Node) {
        return true;
      });
  EXPECT_TRUE(problem.check().ok()) << to_text(problem.check());
  drop_edge(problem.mesh, at(2, 3), at(3, 3));
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kChains});
}

TEST(Chains, ASegmentThatTheMeshIgnoresIsAViolation) {
  Problem problem = block(4);
  // From (1, 1) to (3, 2), which no lattice edges follow.
  problem.domain.points.insert(problem.domain.points.end(), {at(1, 1), at(3, 2)});
  problem.domain.segments.push_back({4, 5});
  problem.domain.markers.push_back(0);
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kChains});
}

TEST(Chains, ACrossingWithoutAVertexIsAViolation) {
  Problem problem = Lattice(4).box({0, 0}, {4, 4}).segment({1, 2}, {3, 2}).build([](Lattice::Node) {
    return true;
  });
  // Across the middle of the edge from (1, 2) to (2, 2).
  problem.domain.points.insert(problem.domain.points.end(), {at(2, 1), at(1, 3)});
  problem.domain.points.back() = {2.5, 3};
  problem.domain.points[problem.domain.points.size() - 2] = {2.5, 1};
  problem.domain.segments.push_back({6, 7});
  problem.domain.markers.push_back(0);
  const Report report = problem.check();
  EXPECT_TRUE(violated(report).contains(Rule::kChains)) << to_text(report);
}

TEST(Chains, SegmentsMayCrossAtAVertex) {
  const Report report = Lattice(4)
                            .box({0, 0}, {4, 4})
                            .segment({1, 2}, {3, 2}, 5)
                            .segment({2, 1}, {2, 3}, 6)
                            .build([](Lattice::Node) { return true; })
                            .check();
  EXPECT_TRUE(report.ok()) << to_text(report);
}

TEST(Chains, ASegmentOutsideOrInAHoleNeedsNone) {
  Problem problem = block_with_hole();
  problem.domain.points.insert(problem.domain.points.end(), {{4, 3}, {4.5, 3}, {-3, 0}, {-2, 5}});
  problem.domain.segments.insert(problem.domain.segments.end(), {{8, 9}, {10, 11}});
  problem.domain.markers.insert(problem.domain.markers.end(), {0, 0});
  const Report report = problem.check();
  EXPECT_TRUE(report.ok()) << to_text(report);
}

TEST(Chains, ASegmentThatSticksOutNeedsOneInsideOnly) {
  Problem problem = block(4);
  // Along y = 2 from (1, 2) through the right side, on and out.
  problem.domain.points.insert(problem.domain.points.end(), {at(1, 2), {20, 2}});
  problem.domain.segments.push_back({4, 5});
  problem.domain.markers.push_back(9);
  for (int i = 1; i < 4; ++i)
    problem.mesh.edges.push_back(
        {vertex(problem.mesh, at(i, 2)), vertex(problem.mesh, at(i + 1, 2)), 9});
  const Report report = problem.check();
  EXPECT_TRUE(report.ok()) << to_text(report);
}

TEST(Points, AnInputPointWithoutAVertexIsAViolation) {
  Problem problem = block(3);
  problem.domain.points.push_back({2.25, 1.5});
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kPoints});
  EXPECT_EQ(report.violations[0].sentence,
            "input point 4 at (2.25, 1.5) is in the domain, but no vertex is there");
}

TEST(Points, AnInputPointOnASegmentNeedsAVertexToo) {
  Problem problem = block(3);
  problem.domain.points.push_back({1.5, 0});
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kPoints});
}

TEST(Points, AnInputPointOutsideOrInAHoleNeedsNone) {
  Problem problem = block_with_hole();
  problem.domain.points.insert(problem.domain.points.end(), {{4.25, 3}, {-7, 0}});
  EXPECT_TRUE(problem.check().ok());
}

TEST(Points, AnInputPointThatIsAVertexIsFine) {
  Problem problem = block(3);
  problem.domain.points.insert(problem.domain.points.end(), {at(1, 1), at(1, 1), at(2, 0)});
  EXPECT_TRUE(problem.check().ok());
}

TEST(Markers, AWrongMarkerIsAViolation) {
  Problem problem = block(3);
  problem.mesh.edges[4].marker = 77;
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kMarkers});
  EXPECT_NE(report.violations[0].sentence.find("has the marker 77, its segment has 1"),
            std::string::npos);
}

TEST(Markers, WhereSegmentsOverlapTheFirstThatIsNotZeroHolds) {
  Problem problem = block(4);
  Domain& domain = problem.domain;
  // The lower side again, in parts: marker 0 for the half from 0 to 2, then 8 for all of it.
  domain.markers[0] = 0;
  domain.points.insert(domain.points.end(), {at(2, 0)});
  domain.segments.insert(domain.segments.end(), {{0, 4}, {1, 0}});
  domain.markers.insert(domain.markers.end(), {6, 8});
  for (int i = 0; i < 4; ++i)
    problem.mesh.edges[listed_edge(problem.mesh, at(i, 0), at(i + 1, 0))].marker = i < 2 ? 6 : 8;
  EXPECT_TRUE(problem.check().ok()) << to_text(problem.check());
  problem.mesh.edges[listed_edge(problem.mesh, at(1, 0), at(2, 0))].marker = 8;
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kMarkers});
}

TEST(Markers, AreZeroWhereNoneAreGiven) {
  Problem problem = block(3);
  problem.domain.markers.clear();
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kMarkers});
  for (Mesh::Edge& edge : problem.mesh.edges) edge.marker = 0;
  EXPECT_TRUE(problem.check().ok());
}

}  // namespace
}  // namespace weft::check::testing
