// SPDX-License-Identifier: Apache-2.0
// Features nearer than the merging distance T: a mesh may merge them, by no more than T.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "checker/domain/tolerance.h"
#include "checker/geometry/predicates.h"
#include "tests/checker/lattice.h"

namespace weft::check::testing {
namespace {

using Rules = std::set<Rule>;

constexpr double kSnap = 0.01;

// Adds the quadrilateral a, b, c, d, counter-clockwise, by its Delaunay diagonal.
void add_quad(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d,
              std::int32_t region) {
  const std::vector<Vec2>& v = mesh.vertices;
  if (in_circle(v[a], v[b], v[c], v[d]) > 0)
    mesh.triangles.insert(mesh.triangles.end(), {{a, b, d}, {b, c, d}});
  else
    mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
  mesh.regions.insert(mesh.regions.end(), 2, region);
}

// A room of 4 x 4 at `corner`, and a wall that comes from the top and ends `gap` above the bottom:
// region 1 on its left, 2 on its right. Points 4 (below) and 5 are the ends of the wall.
Problem room(double gap, Vec2 corner = {}) {
  Problem problem;
  Domain& domain = problem.domain;
  domain.points = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {2, gap}, {2.5, 4}};
  for (Vec2& p : domain.points) p = {corner.x + p.x, corner.y + p.y};
  domain.segments = {{0, 1}, {1, 2}, {2, 5}, {5, 3}, {3, 0}, {4, 5}};
  domain.markers = {1, 2, 3, 3, 4, 5};
  domain.regions = {{{corner.x + 0.5, corner.y + 2}, 1, std::nullopt},
                    {{corner.x + 3.5, corner.y + 2}, 2, std::nullopt}};
  domain.snap = kSnap;
  problem.mesh.vertices = domain.points;
  problem.mesh.edges = {{1, 2, 2}, {2, 5, 3}, {5, 3, 3}, {3, 0, 4}, {4, 5, 5}};
  return problem;
}

// The bottom is led through the end of the wall.
Problem closed_room(double gap, Vec2 corner = {}) {
  Problem problem = room(gap, corner);
  add_quad(problem.mesh, 0, 4, 5, 3, 1);
  add_quad(problem.mesh, 4, 1, 2, 5, 2);
  problem.mesh.edges.insert(problem.mesh.edges.end(), {{0, 4, 1}, {4, 1, 1}});
  return problem;
}

// The bottom passes below the end of the wall. One region: of two seeds in a face, the last wins.
Problem open_room(double gap, Vec2 corner = {}) {
  Problem problem = room(gap, corner);
  add_quad(problem.mesh, 0, 4, 5, 3, 2);
  add_quad(problem.mesh, 4, 1, 2, 5, 2);
  problem.mesh.triangles.push_back({0, 1, 4});
  problem.mesh.regions.push_back(2);
  problem.mesh.edges.push_back({0, 1, 1});
  return problem;
}

TEST(CheckersMerging, AWallMayEndBesideAnotherOneOnBothSides) {
  for (const double gap : {-0.009, -0.004, -1e-9, 1e-9, 0.004, 0.009}) {
    const Report report = closed_room(gap).check();
    EXPECT_TRUE(report.ok()) << gap << "\n" << to_text(report);
  }
}

TEST(CheckersMerging, KnowsTheRegionsOnBothSides) {
  Problem problem = closed_room(0.004);
  problem.mesh.regions[0] = 2;
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kRegions});
}

TEST(CheckersMerging, KnowsTheMarkersOfBentSegments) {
  Problem problem = closed_room(0.004);
  problem.mesh.edges.back().marker = 7;
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kMarkers});
}

TEST(CheckersMerging, MustBeDoneBelowTheDistance) {
  EXPECT_FALSE(open_room(0.005).check().ok());
  const Report report = open_room(0.05).check();
  EXPECT_TRUE(report.ok()) << to_text(report);
}

TEST(CheckersMerging, DoesNotReachFarther) {
  EXPECT_TRUE(violated(closed_room(0.03).check()).contains(Rule::kChains)) << "a vertex at 3 T";
  EXPECT_FALSE(closed_room(0.05).check().ok());
}

TEST(CheckersMerging, IsLimitedByDoublePrecisionWithoutSnap) {
  const Vec2 utm{5e5, 4.65e6};
  const double floor = 0x1p-40 * (utm.y + 4);
  for (int decimals = 2; decimals <= 9; ++decimals) {
    const double gap = 0.4 * std::pow(10.0, -decimals);
    Problem closed = closed_room(gap, utm), open = open_room(gap, utm);
    closed.domain.snap = open.domain.snap = 0;
    EXPECT_EQ(closed.check().ok(), gap < floor) << decimals << "\n" << to_text(closed.check());
    EXPECT_EQ(open.check().ok(), gap > floor) << decimals << "\n" << to_text(open.check());
    closed.domain.snap = open.domain.snap = kSnap;
    EXPECT_TRUE(closed.check().ok()) << decimals << "\n" << to_text(closed.check());
    EXPECT_FALSE(open.check().ok()) << decimals;
  }
}

// A room with a wall of two parts that were meant to meet in the middle, (2, 2) and `other`.
Problem broken_wall(Vec2 other) {
  Problem problem;
  Domain& domain = problem.domain;
  domain.points = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {2, 2}, other, {1.5, 0}, {2.5, 4}};
  domain.segments = {{0, 6}, {6, 1}, {1, 2}, {2, 7}, {7, 3}, {3, 0}, {6, 4}, {5, 7}};
  domain.regions = {{{0.5, 2}, 1, std::nullopt}, {{3.5, 2}, 2, std::nullopt}};
  domain.snap = kSnap;
  Mesh& mesh = problem.mesh;
  mesh.vertices = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {2, 2}, {1.5, 0}, {2.5, 4}};
  mesh.triangles = {{0, 4, 3}, {0, 5, 4}, {4, 6, 3}, {1, 2, 4}, {5, 1, 4}, {2, 6, 4}};
  mesh.regions = {1, 1, 1, 2, 2, 2};
  mesh.edges = {{0, 5, 0}, {5, 1, 0}, {1, 2, 0}, {2, 6, 0},
                {6, 3, 0}, {3, 0, 0}, {5, 4, 0}, {4, 6, 0}};
  mesh.input_points = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, 4}, {5, 6}, {6, 7}};
  return problem;
}

TEST(CheckersMerging, APointMayMoveOntoAnother) {
  Problem problem = broken_wall({2.004, 2.006});
  Report report = problem.check();
  EXPECT_TRUE(report.ok()) << to_text(report);
  problem.mesh.input_points.clear();
  report = problem.check();
  EXPECT_TRUE(report.ok()) << to_text(report);
}

TEST(CheckersMerging, APointMayNotMoveFarther) {
  EXPECT_TRUE(violated(broken_wall({2.02, 2.02}).check()).contains(Rule::kPoints));
  // Both points within T of each other, and the vertex 3 T away.
  Problem problem = broken_wall({2.004, 2.006});
  problem.mesh.vertices[4] = {2 + 3 * kSnap, 2};
  EXPECT_TRUE(violated(problem.check()).contains(Rule::kPoints)) << to_text(problem.check());
}

TEST(CheckersMerging, HoldsTheMeshToWhereItSaysPointsAre) {
  Problem problem = broken_wall({2.004, 2.006});
  problem.mesh.input_points[4] = {5, 4};
  EXPECT_TRUE(violated(problem.check()).contains(Rule::kPoints));
  problem = broken_wall({2.004, 2.006});
  problem.mesh.input_points.push_back({9, 0});
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kPoints});
  problem = broken_wall({2.004, 2.006});
  problem.mesh.input_points.push_back({4, 5});
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kPoints}) << "a vertex is named twice";
}

// A room with two walls from bottom to top, `width` apart, of which the mesh has the left one.
Problem double_wall(double width) {
  Problem problem = closed_room(0);
  Domain& domain = problem.domain;
  domain.points.insert(domain.points.end(), {{2 + width, 0}, {2.5 + width, 4}});
  domain.segments.push_back({6, 7});
  domain.markers.push_back(5);
  return problem;
}

TEST(CheckersMerging, AFaceMayVanishIfItIsThin) {
  for (const double width : {1e-9, 0.004, 0.009}) {
    const Report report = double_wall(width).check();
    EXPECT_TRUE(report.ok()) << width << "\n" << to_text(report);
  }
}

TEST(CheckersMerging, AFaceMayNotVanishIfItIsWide) {
  for (const double width : {0.03, 0.05, 0.1})
    EXPECT_TRUE(violated(double_wall(width).check()).contains(Rule::kPoints)) << width;
  // Its corners may be there, and the face may still be missing.
  Problem problem = closed_room(0);
  problem.domain.points.push_back({2.1, 2});
  problem.domain.segments.insert(problem.domain.segments.end(), {{4, 6}, {6, 5}});
  problem.domain.markers.insert(problem.domain.markers.end(), {5, 5});
  EXPECT_FALSE(problem.check().ok());
}

TEST(CheckersMerging, AChainBendsOnlyAtWhatPullsIt) {
  // The left end of the bottom has a point beside it, so the bottom may bend, but not here.
  Problem problem = closed_room(0.004);
  Mesh& mesh = problem.mesh;
  const Report report = problem.check();
  EXPECT_TRUE(report.ok()) << to_text(report);
  mesh.vertices.push_back({1, 0.004});  // between vertices 0 and 4
  std::erase_if(mesh.edges, [](const Mesh::Edge& e) { return e.a == 0 && e.b == 4; });
  mesh.edges.insert(mesh.edges.end(), {{0, 6, 1}, {6, 4, 1}});
  mesh.triangles.clear();
  mesh.regions.clear();
  add_quad(mesh, 6, 4, 5, 3, 1);
  mesh.triangles.push_back({0, 6, 3});
  mesh.regions.push_back(1);
  add_quad(mesh, 4, 1, 2, 5, 2);
  EXPECT_TRUE(violated(problem.check()).contains(Rule::kChains)) << to_text(problem.check());
  mesh.vertices.back().y = 0.002;  // on the way from (0, 0) to (2, 0.004)
  EXPECT_TRUE(problem.check().ok()) << to_text(problem.check());
}

// A room of 4 x 4 of which the mesh has the triangle below its top; the rest is hole. The right
// side is bent, because the bottom is there twice and ends 0.005 apart, and the mesh lacks it. Edge
// 1 is the piece of the triangle's right side, marker 5, that begins within T of it.
Problem corner() {
  Problem problem;
  Domain& domain = problem.domain;
  domain.points = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {2, 0}, {3.995, 0}};
  domain.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {3, 4}, {2, 4}, {0, 5}};
  domain.markers = {1, 2, 3, 4, 5, 5, 1};
  domain.holes = {{0.5, 1}, {3.5, 1}};
  domain.snap = kSnap;
  Mesh& mesh = problem.mesh;
  mesh.vertices = {{4, 4}, {0, 4}, {2, 0}, {3.996, 3.992}};
  mesh.triangles = {{1, 2, 3}, {0, 1, 3}};
  mesh.edges = {{2, 3, 5}, {3, 0, 5}, {0, 1, 3}, {1, 2, 5}};
  return problem;
}

// A room of 4 x 4, and a segment, marker 5, that passes below it and is led through its corner
// (4, 0). Edge 0 is the last piece of the bottom, which has no marker; it is within T of the
// segment.
Problem passed_corner() {
  Problem problem;
  problem.domain.points = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, -0.03}, {4.02, 0}};
  problem.domain.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}};
  problem.domain.markers = {0, 2, 3, 4, 5};
  problem.domain.snap = kSnap / 10;
  problem.mesh.vertices = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {3.9, 0}};
  problem.mesh.triangles = {{0, 4, 3}, {4, 2, 3}, {4, 1, 2}};
  problem.mesh.edges = {{4, 1, 0}, {0, 4, 0}, {1, 2, 2}, {2, 3, 3}, {3, 0, 4}};
  return problem;
}

// A room of 4 x 4, and a segment, marker 5, that leaves it at point 4 on the bottom, at a small
// angle, and is led through point 5 there, 0.0005 beside it. Edge 2 is the next piece of the
// bottom.
Problem slow_leave() {
  Problem problem;
  problem.domain.points = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {1, 0}, {1.05, 0}, {3.95, -0.03}};
  problem.domain.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 6}};
  problem.domain.markers = {0, 2, 3, 4, 5};
  problem.domain.snap = kSnap / 10;
  problem.mesh.vertices = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {1, 0}, {1.05, 0}, {1.08, 0}};
  problem.mesh.triangles = {{0, 4, 3}, {4, 5, 3}, {5, 6, 3}, {6, 2, 3}, {6, 1, 2}};
  problem.mesh.edges = {{0, 4, 0}, {4, 5, 5}, {5, 6, 0}, {6, 1, 0},
                        {1, 2, 2}, {2, 3, 3}, {3, 0, 4}};
  return problem;
}

TEST(CheckersMerging, AnEdgeOnASegmentMayHaveItsMarkerBesideABentOne) {
  for (const Problem& problem : {corner(), passed_corner(), slow_leave()}) {
    const Report report = problem.check();
    EXPECT_TRUE(report.ok()) << to_text(report);
  }
}

TEST(CheckersMerging, KnowsTheMarkersBesideBentSegments) {
  Problem problem = corner();
  problem.mesh.edges[1].marker = 7;
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kMarkers}) << "that of no segment";
  problem = passed_corner();
  problem.mesh.edges[0].marker = 7;
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kMarkers}) << "that of no segment";
  problem = passed_corner();
  problem.mesh.edges[1].marker = 5;
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kMarkers}) << "that of one far away";
  problem = corner();
  problem.mesh.edges[0].marker = 2;
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kMarkers}) << "that of one far away";
}

TEST(CheckersMerging, ASegmentOutsideDoesNotTakeTheEdgesOfOthers) {
  // Otherwise the last piece of the bottom would be two segments, and no border by this rule.
  Problem problem = passed_corner();
  problem.domain.fill = Fill::kEvenOdd;
  const Report report = problem.check();
  EXPECT_TRUE(report.ok()) << to_text(report);
}

// A square far from the origin. All of it is hole, except a triangle whose tip is below the
// square's lower side, by so much of T. If `beyond`, two segments cross at the tip and go on.
Problem tip(double below, bool beyond) {
  constexpr double kFar = 1e6;
  const double y = -below * 0x1p-40 * kFar;
  Problem problem;
  Domain& domain = problem.domain;
  domain.points = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {1.9, 3}, {2.1, 3}, {2, y}};
  domain.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 4}};
  if (beyond) {
    domain.points[6] = {2.1, 2 * y - 3};
    domain.points.push_back({1.9, 2 * y - 3});
    domain.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 7}, {6, 4}};
  }
  domain.holes = {{1, 1}};
  problem.mesh.vertices = {{1.9, 3}, {2, y}, {2.1, 3}};
  problem.mesh.triangles = {{0, 1, 2}};
  problem.mesh.edges = {{0, 1, 0}, {1, 2, 0}, {2, 0, 0}};
  for (std::vector<Vec2>* points : {&domain.points, &domain.holes, &problem.mesh.vertices})
    for (Vec2& p : *points) p = {kFar + p.x, kFar + p.y};
  return problem;
}

TEST(CheckersMerging, ASegmentOutsideIsLedThroughWhatItPasses) {
  for (const bool beyond : {false, true}) {
    for (const double below : {-0.9, -0.4, -0.02, 0.02, 0.04, 0.4, 0.9}) {
      const Report report = tip(below, beyond).check();
      EXPECT_TRUE(report.ok()) << beyond << " " << below << "\n" << to_text(report);
    }
    EXPECT_FALSE(tip(100, beyond).check().ok()) << beyond;
  }
}

// Three segments from points 0, 1, 2 to 3, 4, 5, which stand around counter-clockwise, in a mesh
// that joins all to `meeting`.
Problem star_of(const std::vector<Vec2>& points, Vec2 meeting) {
  Problem problem;
  problem.domain.points = problem.mesh.vertices = points;
  problem.domain.segments = {{0, 3}, {1, 4}, {2, 5}};
  problem.mesh.vertices.push_back(meeting);
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t next = (i + 1) % 6;
    problem.domain.segments.push_back({i, next});
    problem.mesh.triangles.push_back({6, i, next});
    problem.mesh.edges.insert(problem.mesh.edges.end(), {{i, 6, 0}, {i, next, 0}});
  }
  return problem;
}

TEST(CheckersMerging, RoundingMayLeadThreeSegmentsThroughOneVertex) {
  // Through one point but for 6 units in the last place, and a vertex 12 units from it.
  const std::vector<Vec2> at_large_angles{{4, 2}, {4, 4 + 8e-15}, {2, 4},
                                          {0, 2}, {0, 0 + 8e-15}, {2, 0}};
  Report report = star_of(at_large_angles, {2, 2 - 1.3e-14}).check();
  EXPECT_TRUE(report.ok()) << to_text(report);
  EXPECT_FALSE(star_of(at_large_angles, {2, 2 - 1e-10}).check().ok());
  // Two at a small angle: their vertex may be far along both.
  const std::vector<Vec2> at_a_small_angle{{4, 2}, {2.2, 4}, {2, 4}, {0, 2}, {1.8, 0}, {2, 0}};
  report = star_of(at_a_small_angle, {2, 2 + 1.6e-14}).check();
  EXPECT_TRUE(report.ok()) << to_text(report);
  EXPECT_FALSE(star_of(at_a_small_angle, {2, 2 + 1e-10}).check().ok());
}

TEST(CheckersMerging, ChangesNothingWhereNothingIsNear) {
  for (Problem problem : {block(5), block_with_hole(), block_with_regions()}) {
    problem.domain.snap = kSnap;
    EXPECT_TRUE(problem.check().ok());
    problem.mesh.vertices[vertex(problem.mesh, Lattice::at({2, 0}))].y += 1e-12;
    EXPECT_TRUE(violated(problem.check()).contains(Rule::kChains));
    problem.mesh.vertices[vertex(problem.mesh, Lattice::at({0, 0}))].x -= 1e-9;
    EXPECT_TRUE(violated(problem.check()).contains(Rule::kPoints));
  }
}

TEST(CheckersMerging, TheDistanceMustBeUsable) {
  for (const double snap :
       {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Problem problem = block(2);
    problem.domain.snap = snap;
    EXPECT_TRUE(violated(problem.check()).contains(Rule::kDomain)) << snap;
  }
}

}  // namespace
}  // namespace weft::check::testing
