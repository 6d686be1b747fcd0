// SPDX-License-Identifier: Apache-2.0
// Rules 1 and 2: what triangles must be, and how they must fit together.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/checker/lattice.h"

namespace weft::check::testing {
namespace {

using Rules = std::set<Rule>;

TEST(Check, AcceptsABlock) {
  for (const int size : {1, 2, 7}) {
    const Report report = block(size).check();
    EXPECT_TRUE(report.ok()) << to_text(report);
    EXPECT_TRUE(report.not_judged.empty());
  }
}

TEST(Check, AcceptsABlockWithAHole) {
  const Report report = block_with_hole().check();
  EXPECT_TRUE(report.ok()) << to_text(report);
}

TEST(Check, AcceptsABlockWithRegions) {
  const Report report = block_with_regions().check();
  EXPECT_TRUE(report.ok()) << to_text(report);
}

TEST(Check, AcceptsComponentsApart) {
  const Report report =
      Lattice(8)
          .box({0, 0}, {3, 3})
          .box({5, 5}, {8, 8})
          .build([](Lattice::Node c) { return (c[0] < 3 && c[1] < 3) || (c[0] >= 5 && c[1] >= 5); })
          .check();
  EXPECT_TRUE(report.ok()) << to_text(report);
}

TEST(Check, AcceptsComponentsThatMeetInAPoint) {
  const Report report = Lattice(6)
                            .box({0, 0}, {3, 3})
                            .box({3, 3}, {6, 6})
                            .build([](Lattice::Node c) { return (c[0] < 3) == (c[1] < 3); })
                            .check();
  EXPECT_TRUE(report.ok()) << to_text(report);
}

TEST(Structure, AnIndexOutOfRangeIsAViolation) {
  Problem problem = block(3);
  problem.mesh.triangles[4][1] = 1000;
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kStructure});
  EXPECT_NE(report.violations[0].sentence.find("triangle 4 "), std::string::npos);
}

TEST(Structure, ARepeatedCornerIsAViolation) {
  Problem problem = block(3);
  problem.mesh.triangles[4][1] = problem.mesh.triangles[4][0];
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kStructure});
}

TEST(Structure, AVertexWithoutTrianglesIsAViolation) {
  Problem problem = block(3);
  problem.mesh.vertices.push_back({1.25, 1.25});
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kStructure});
  EXPECT_EQ(report.violations[0].sentence, "vertex 16 at (1.25, 1.25) belongs to no triangle");
}

TEST(Structure, ACoordinateThatIsNoNumberIsAViolation) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e200, 1e-200}) {
    Problem problem = block(3);
    problem.mesh.vertices[5].x = bad;
    EXPECT_EQ(violated(problem.check()), Rules{Rule::kStructure}) << bad;
  }
}

TEST(Structure, ListsOfUnequalLengthAreAViolation) {
  Problem problem = block(3);
  problem.mesh.regions = {0};
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kStructure});
}

TEST(Structure, AnEmptyMeshIsAViolation) {
  Problem problem = block(3);
  problem.mesh = {};
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kStructure});
}

TEST(OrientationRule, AClockwiseTriangleIsAViolation) {
  Problem problem = block(3);
  std::swap(problem.mesh.triangles[7][0], problem.mesh.triangles[7][1]);
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kOrientation});
  EXPECT_NE(report.violations[0].sentence.find("triangle 7 "), std::string::npos);
}

TEST(OrientationRule, AFlatTriangleIsAViolation) {
  Problem problem = block(2);
  // The middle vertex, onto the line between two of its neighbours.
  problem.mesh.vertices[vertex(problem.mesh, Lattice::at({1, 1}))] = {1.5, 0.5};
  // (2, 0), (1.5, 0.5) and (1, 1) would be on a line; (1, 0), (2, 0) are below it.
  const std::set<Rule> rules = violated(problem.check());
  EXPECT_FALSE(rules.contains(Rule::kStructure));
  EXPECT_FALSE(rules.empty());
  problem.mesh.vertices[vertex(problem.mesh, {1.5, 0.5})] = {1.5, 0};
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kOrientation});
}

TEST(OrientationRule, AVertexMovedAcrossAnEdgeIsAViolation) {
  Problem problem = block(4);
  problem.mesh.vertices[vertex(problem.mesh, Lattice::at({2, 2}))] = {4.5, 2.25};
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kOrientation});
}

TEST(Conformity, ATriangleTwiceIsAViolation) {
  Problem problem = block(3);
  problem.mesh.triangles.push_back(problem.mesh.triangles[5]);
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kConformity});
  EXPECT_GE(report.total(Rule::kConformity), 3u);
}

TEST(Conformity, AThirdTriangleOnAnEdgeIsAViolation) {
  Problem problem = block(3);
  const std::uint32_t a = vertex(problem.mesh, Lattice::at({1, 1}));
  const std::uint32_t b = vertex(problem.mesh, Lattice::at({2, 1}));
  problem.mesh.vertices.push_back({2.0, 1.1});
  problem.mesh.triangles.push_back(
      {a, b, static_cast<std::uint32_t>(problem.mesh.vertices.size() - 1)});
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kConformity});
}

TEST(Overlap, AHangingVertexIsAViolation) {
  Problem problem = block(2);
  Mesh& mesh = problem.mesh;
  // Split one of the two triangles at an inner edge, not the other.
  const Vec2 p = Lattice::at({1, 0}), q = Lattice::at({0, 1}), r = Lattice::at({0, 0});
  const std::size_t t = triangle(mesh, p, q, r);
  const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back({(p.x + q.x) / 2, (p.y + q.y) / 2});
  mesh.triangles[t] = {vertex(mesh, r), vertex(mesh, p), middle};
  mesh.triangles.push_back({vertex(mesh, r), middle, vertex(mesh, q)});
  problem.requirements = {};
  EXPECT_EQ(violated(problem.check()), (Rules{Rule::kEdges, Rule::kOverlap}));
}

TEST(Overlap, AComponentOnTopOfAnotherIsAViolation) {
  Problem problem = block(4);
  Mesh& mesh = problem.mesh;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {{3, 1.25}, {3.5, 1.25}, {3.25, 1.75}});
  mesh.triangles.push_back({first, first + 1, first + 2});
  for (std::uint32_t i = 0; i < 3; ++i) mesh.edges.push_back({first + i, first + (i + 1) % 3, 0});
  const Report report = problem.check();
  EXPECT_TRUE(report.total(Rule::kOverlap) > 0) << to_text(report);
}

TEST(Overlap, TheWholeMeshTwiceIsAViolation) {
  Problem problem = block(3);
  Mesh& mesh = problem.mesh;
  const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
  const Mesh copy = mesh;
  mesh.vertices.insert(mesh.vertices.end(), copy.vertices.begin(), copy.vertices.end());
  for (const auto& [a, b, c] : copy.triangles)
    mesh.triangles.push_back({a + offset, b + offset, c + offset});
  for (const auto& [a, b, marker] : copy.edges)
    mesh.edges.push_back({a + offset, b + offset, marker});
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kOverlap});
}

TEST(Overlap, BoundariesThatCrossAreAViolation) {
  Problem problem = block(3);
  Mesh& mesh = problem.mesh;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {{1, -1}, {2, -1}, {1.5, 0.5}});
  mesh.triangles.push_back({first, first + 1, first + 2});
  for (std::uint32_t i = 0; i < 3; ++i) mesh.edges.push_back({first + i, first + (i + 1) % 3, 0});
  problem.requirements = {};
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kOverlap});
  EXPECT_NE(to_text(report).find(" cross"), std::string::npos);
}

TEST(Overlap, AFanThatTurnsTwiceIsAViolation) {
  // Six triangles around the origin whose ring winds around it twice.
  Problem problem;
  Mesh& mesh = problem.mesh;
  mesh.vertices = {{0, 0}};
  for (int k = 0; k < 6; ++k) {
    const double angle = k * 2 * 2 * std::acos(-1.0) / 6, radius = k < 3 ? 1 : 2;
    mesh.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  for (std::uint32_t k = 0; k < 6; ++k) mesh.triangles.push_back({0, 1 + k, 1 + (k + 1) % 6});
  for (std::uint32_t k = 0; k < 6; ++k) mesh.edges.push_back({1 + k, 1 + (k + 1) % 6, 0});
  const Report report = problem.check();
  EXPECT_GT(report.total(Rule::kOverlap), 0u) << to_text(report);
  EXPECT_EQ(report.total(Rule::kConformity), 0u);
}

TEST(Overlap, AVertexTwiceAtOnePlaceIsAViolation) {
  // Two components that meet in a point, each with a vertex of its own there.
  Problem problem = Lattice(6).box({0, 0}, {3, 3}).box({3, 3}, {6, 6}).build([](Lattice::Node c) {
    return (c[0] < 3) == (c[1] < 3);
  });
  Mesh& mesh = problem.mesh;
  const Vec2 pinch = Lattice::at({3, 3});
  const std::uint32_t v = vertex(mesh, pinch);
  const auto copy = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(pinch);
  const auto above = [&](std::uint32_t i) { return mesh.vertices[i].y > 3; };
  for (auto& corners : mesh.triangles)
    if (std::any_of(corners.begin(), corners.end(), above))
      std::replace(corners.begin(), corners.end(), v, copy);
  for (Mesh::Edge& edge : mesh.edges) {
    if (above(edge.b) && edge.a == v) edge.a = copy;
    if (above(edge.a) && edge.b == v) edge.b = copy;
  }
  // The two edges along y = 3 that leave the pinch to the right belong to the upper component.
  for (Mesh::Edge& edge : mesh.edges) {
    if (edge.a == v && mesh.vertices[edge.b].x > pinch.x && mesh.vertices[edge.b].y == 3)
      edge.a = copy;
    if (edge.b == v && mesh.vertices[edge.a].x > pinch.x && mesh.vertices[edge.a].y == 3)
      edge.b = copy;
  }
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kOverlap});
  EXPECT_NE(to_text(report).find("are both at (4.5, 3)"), std::string::npos) << to_text(report);
}

TEST(Delaunay, AFlippedDiagonalIsAViolation) {
  Problem problem = block(4);
  Mesh& mesh = problem.mesh;
  const auto at = [&](int i, int j) { return vertex(mesh, Lattice::at({i, j})); };
  const std::uint32_t a = at(1, 1), b = at(2, 1), c = at(2, 2), d = at(1, 2);
  const std::size_t low =
      triangle(mesh, Lattice::at({1, 1}), Lattice::at({2, 1}), Lattice::at({1, 2}));
  const std::size_t high =
      triangle(mesh, Lattice::at({2, 1}), Lattice::at({2, 2}), Lattice::at({1, 2}));
  mesh.triangles[low] = {a, b, c};
  mesh.triangles[high] = {a, c, d};
  problem.requirements.min_angle_deg = 20;
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kDelaunay});
  EXPECT_EQ(report.total(Rule::kDelaunay), 1u);
}

TEST(Delaunay, FourPointsOnACircleMayHaveEitherDiagonal) {
  Problem problem;
  problem.domain.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  problem.domain.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  problem.mesh.vertices = problem.domain.points;
  problem.mesh.edges = {{0, 1, 0}, {1, 2, 0}, {2, 3, 0}, {3, 0, 0}};
  problem.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_TRUE(problem.check().ok());
  problem.mesh.triangles = {{0, 1, 3}, {1, 2, 3}};
  EXPECT_TRUE(problem.check().ok());
}

TEST(Delaunay, AListedEdgeNeedNotBeDelaunay) {
  Problem problem;
  problem.domain.points = {{0, 0}, {1, -0.1}, {2, 0}, {1, 0.1}};
  problem.domain.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 2}};
  problem.mesh.vertices = problem.domain.points;
  problem.mesh.edges = {{0, 1, 0}, {1, 2, 0}, {2, 3, 0}, {3, 0, 0}, {0, 2, 0}};
  problem.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_TRUE(problem.check().ok());
  problem.domain.segments.pop_back();
  problem.mesh.edges.pop_back();
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kDelaunay});
}

}  // namespace
}  // namespace weft::check::testing
