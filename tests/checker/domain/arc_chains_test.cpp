// SPDX-License-Identifier: Apache-2.0
// Meshes of domains with arcs that are right.
#include "checker/domain/arc_chains.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/checker/drawing.h"

namespace weft::check::testing {
namespace {

bool all(Vec2) {
  return true;
}

void circle(Drawing& drawing, Vec2 centre, double radius, int pieces, std::int32_t marker = 0) {
  drawing.arc(centre, radius, 0, 180, pieces / 2, marker);
  drawing.arc(centre, radius, 180, 360, pieces / 2, marker);
}

void square(Drawing& drawing, double half, std::int32_t marker = 0) {
  drawing.line({{-half, -half}, {half, -half}}, marker);
  drawing.line({{half, -half}, {half, half}}, marker);
  drawing.line({{half, half}, {-half, half}}, marker);
  drawing.line({{-half, half}, {-half, -half}}, marker);
}

void expect_ok(const Problem& problem) {
  const Report report = problem.check();
  EXPECT_TRUE(report.ok()) << to_text(report);
  EXPECT_TRUE(report.not_judged.empty());
}

TEST(ArcChains, OfADiskAreAccepted) {
  for (const Vec2 centre : {Vec2{0, 0}, Vec2{1000, -300}})
    for (const int pieces : {6, 12, 60}) {
      Drawing drawing;
      circle(drawing, centre, 1, pieces, 7);
      expect_ok(drawing.vertex(centre).mesh(all));
    }
}

TEST(ArcChains, MayTurnRightOrLeftFromAnyEnd) {
  for (const double start : {0.0, 45.0, 90.0, 135.0, 225.0, 300.0})
    for (const double turn : {120.0, -120.0}) {
      Drawing drawing;
      for (int k = 0; k < 3; ++k)
        drawing.arc({0, 0}, 1, start + k * turn, start + (k + 1) * turn, 4, k);
      expect_ok(drawing.vertex({0, 0}).mesh(all));
    }
}

TEST(ArcChains, OfNearlyAWholeCircleAreAccepted) {
  Drawing drawing;
  drawing.arc({3, 1}, 1, 10, 350, 17);
  drawing.line({on_circle({3, 1}, 1, 350), on_circle({3, 1}, 1, 10)});
  expect_ok(drawing.mesh(all));
}

TEST(ArcChains, OfAnArcThatIsNearlyStraightAreAccepted) {
  // Of bulge 1e-6, over a side of the square.
  Drawing drawing;
  drawing.line({{0, 1}, {0, 0}});
  drawing.line({{2, 0}, {2, 1}});
  drawing.line({{2, 1}, {0, 1}});
  Problem problem =
      drawing.line({{0, 0}, {1, -1e-6}, {2, 0}}, 4).mesh([](Vec2 p) { return p.y > 0; });
  problem.domain.arcs = {{3, 1e-6}};
  expect_ok(problem);
  problem.mesh.vertices[vertex_near(problem.mesh, {1, -1e-6})].y = -2e-6;
  EXPECT_TRUE(violated(problem.check()).contains(Rule::kChains));
}

TEST(ArcChains, OfAHoleInASquareAreAccepted) {
  Drawing drawing;
  square(drawing, 2, 1);
  circle(drawing, {0, 0}, 1, 12, 2);
  const Problem problem =
      drawing.hole({0, 0}).mesh([](Vec2 p) { return std::hypot(p.x, p.y) > 0.95; });
  expect_ok(problem);
  Problem even_odd = problem;
  even_odd.domain.holes.clear();
  even_odd.domain.fill = Fill::kEvenOdd;
  expect_ok(even_odd);
}

TEST(ArcChains, OfAHalfDiskAreAccepted) {
  Drawing drawing;
  expect_ok(drawing.arc({0, 0}, 1, 0, 180, 6, 3).line({{-1, 0}, {0, 0}, {1, 0}}, 5).mesh(all));
}

TEST(ArcChains, OfSegmentsWithTheSameEndsAreToldApart) {
  // A cap of 40 degrees on its chord: as one more face, as a hole, and left out.
  const Vec2 a = on_circle({0, 0}, 1, 70), b = on_circle({0, 0}, 1, 110);
  const auto cap = [&](int pieces) {
    Drawing drawing;
    drawing.line({b, {b.x, 0}}).line({{b.x, 0}, {a.x, 0}}).line({{a.x, 0}, a}).line({a, b}, 2);
    return drawing.arc({0, 0}, 1, 70, 110, pieces, 3);
  };
  expect_ok(cap(2).mesh(all));
  expect_ok(cap(0).hole({0, 0.97}).mesh(all));
  EXPECT_EQ(violated(cap(0).mesh(all).check()), (std::set<Rule>{Rule::kChains, Rule::kCoverage}));
}

Problem crossing_circles() {
  Drawing drawing;
  const Vec2 left{-0.5, 0}, right{0.5, 0};
  circle(drawing, left, 1, 12, 1);
  circle(drawing, right, 1, 12, 2);
  drawing.region({-1.2, 0}, 10).region({0, 0.1}, 20).region({1.2, 0}, 30);
  const auto is_in = [](Vec2 p, Vec2 centre) {
    return std::hypot(p.x - centre.x, p.y - centre.y) < 1;
  };
  return drawing.mesh([=](Vec2 p) { return is_in(p, left) || is_in(p, right); },
                      [=](Vec2 p) {
                        return is_in(p, left) && is_in(p, right) ? 20 : is_in(p, left) ? 10 : 30;
                      });
}

// From inside of the circle to its border, or across that.
Problem crossing_line(double beyond) {
  Drawing drawing;
  circle(drawing, {0, 0}, 1, 12, 1);
  const Vec2 from = on_circle({0, 0}, 0.4, 210);
  Problem problem = drawing.line({from, {0, 0}, on_circle({0, 0}, 1, 30)}).mesh(all);
  problem.domain.points.back() = on_circle({0, 0}, 1 + beyond, 30);
  return problem;
}

// Between a disk and the square around it: an arc nearer to the disk than chords of 5 degrees are
// to their arcs, and two that cross, with a seed that is nearly on one of them.
Problem arcs_in_a_hole() {
  Drawing drawing;
  square(drawing, 2);
  circle(drawing, {0, 0}, 1, 12);
  circle(drawing, {0, 0}, 0.3, 72);
  drawing.vertex({0, 0}).arc({0, 0}, 0.3002, 20, 100, 0);
  drawing.arc({0, 0.2}, 0.5, 0, 170, 0).arc({0, 0.9}, 0.4, 190, 350, 0);
  drawing.hole({0, 0.7001}).hole({0.01, 0.62});
  return drawing.mesh([](Vec2 p) {
    const double radius = std::hypot(p.x, p.y);
    return radius > 0.95 || radius < 0.3;
  });
}

TEST(ArcChains, OfArcsAndLinesThatCrossAreAccepted) {
  expect_ok(crossing_circles());
  expect_ok(crossing_line(0));
  expect_ok(crossing_line(0.5));
}

TEST(ArcChains, InAHoleAreNotNeeded) {
  expect_ok(arcs_in_a_hole());
}

TEST(ArcChains, AreRightToWithinRounding) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> part(-1, 1);
  for (const Problem& at_origin :
       {crossing_circles(), crossing_line(0), crossing_line(0.5), arcs_in_a_hole()})
    for (int round = 0; round < 40; ++round) {
      Problem problem = at_origin;
      const double far = std::pow(10, 4 * part(random)), angle = 3 * part(random);
      const Vec2 centre{far * part(random), far * part(random)};
      const auto move = [&](Vec2& p) {
        p = {centre.x + p.x * std::cos(angle) - p.y * std::sin(angle),
             centre.y + p.x * std::sin(angle) + p.y * std::cos(angle)};
      };
      for (Vec2& p : problem.domain.points) move(p);
      for (Vec2& p : problem.domain.holes) move(p);
      for (RegionSeed& seed : problem.domain.regions) move(seed.at);
      for (Vec2& p : problem.mesh.vertices) move(p);
      make_delaunay(problem.mesh);
      expect_ok(problem);
    }
}

TEST(ArcChains, TwoEqualArcsHaveOne) {
  for (const bool reversed : {false, true}) {
    Drawing drawing;
    circle(drawing, {0, 0}, 1, 12, 1);
    Problem problem = drawing.vertex({0, 0}).mesh(all);
    auto [a, b] = problem.domain.segments[0];
    problem.domain.segments.push_back(reversed ? SegmentEnds{b, a} : SegmentEnds{a, b});
    problem.domain.markers.push_back(9);
    problem.domain.arcs.push_back({2, reversed ? -1.0 : 1.0});
    expect_ok(problem);
  }
}

TEST(ArcChains, AreNeededInTheMeshOnly) {
  // Across a corner of the square, from outside to outside.
  Drawing drawing;
  drawing.line({{-2, -2}, {2, -2}});
  drawing.line({{2, -2}, {2, 1.5}, {2, 2}});
  drawing.line({{2, 2}, {1.5, 2}, {-2, 2}});
  drawing.line({{-2, 2}, {-2, -2}});
  const double from = std::atan2(1.5, 2) * (180 / std::numbers::pi);
  drawing.arc({0, 0}, 2.5, {from, 90 - from}, 6);
  drawing.arc({0, 0}, 2.5, 0, 90, 0);
  Problem problem = drawing.mesh(all);
  // The arc that was drawn first stands for the part of the other that is in the mesh.
  Domain& domain = problem.domain;
  domain.segments.erase(domain.segments.begin() + 4);
  domain.markers.erase(domain.markers.begin() + 4);
  domain.arcs = {{4, std::tan(std::numbers::pi / 8)}};
  domain.points.erase(domain.points.begin() + 4, domain.points.begin() + 6);
  domain.segments[4] = {4, 5};
  domain.markers[4] = 6;
  expect_ok(problem);
  const auto chord = listed_edge(problem.mesh, {2, 1.5}, {1.5, 2});
  problem.mesh.edges[chord].marker = 5;
  EXPECT_EQ(violated(problem.check()), std::set<Rule>{Rule::kMarkers});
  problem.mesh.edges.erase(problem.mesh.edges.begin() + static_cast<std::ptrdiff_t>(chord));
  EXPECT_TRUE(violated(problem.check()).contains(Rule::kChains));
}

TEST(ArcChains, PassVerticesWithinTheMergingDistance) {
  // The arc ends beside the corner of the square, and a line ends beside the arc.
  for (const double snap : {0.0, 1e-6}) {
    Drawing drawing;
    circle(drawing, {0, 0}, 1, 12, 1);
    Problem problem = drawing.line({{0, 0}, on_circle({0, 0}, 1, 60)}).mesh(all);
    Domain& domain = problem.domain;
    domain.snap = snap;
    ASSERT_EQ(domain.points.size(), 4u);
    domain.points[3] = on_circle({0, 0}, 1 + 1e-7, 60);
    problem.mesh.vertices[vertex_near(problem.mesh, domain.points[3])] = domain.points[3];
    EXPECT_EQ(problem.check().ok(), snap > 0) << to_text(problem.check());
  }
}

TEST(ArcChains, OfAreasAreAccepted) {
  Drawing drawing;
  square(drawing, 2);
  circle(drawing, {0, 0}, 1, 12);
  Problem problem = drawing.fill(Fill::kUnion).vertex({0, 0}).mesh(all, [](Vec2 p) {
    return std::hypot(p.x, p.y) < 0.97 ? 2 : 1;
  });
  problem.domain.areas = {{1, 0, std::nullopt, false}, {2, 1, std::nullopt, false}};
  problem.domain.segment_areas = {1, 1, 1, 1, 2, 2};
  expect_ok(problem);
}

TEST(ArcChains, AreOneSegmentForExemptions) {
  // A line that meets a circle at 15 degrees: its shells reach farther than the first edge.
  const Vec2 centre = on_circle({0, 0}, 1, 105);
  const std::vector<double> degrees{285, 289, 293, 297};
  std::vector<Vec2> above, below;
  for (const double each : degrees) {
    above.push_back(on_circle(centre, 1, each));
    below.push_back({each == 285 ? 0 : std::hypot(above.back().x, above.back().y), 0});
  }
  Drawing drawing;
  drawing.line(below, 1).arc(centre, 1, degrees, 2).line({below.back(), above.back()}, 3);
  Problem problem = drawing.mesh([&](Vec2 p) {
    std::size_t k = 1;
    while (k + 1 < above.size() && above[k].x < p.x) ++k;
    const Vec2 a = above[k - 1], b = above[k];
    return (b.x - a.x) * (p.y - a.y) < (b.y - a.y) * (p.x - a.x) || p.x > b.x;
  });
  problem.requirements.min_angle_deg = 40;
  expect_ok(problem);
  EXPECT_GE(problem.check().facts.exempt_shell, 3u);
}

}  // namespace
}  // namespace weft::check::testing
