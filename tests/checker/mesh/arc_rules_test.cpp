// SPDX-License-Identifier: Apache-2.0
// Each rule of the chains of arcs, broken once.
#include "checker/mesh/arc_rules.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/checker/drawing.h"

namespace weft::check::testing {
namespace {

using Rules = std::set<Rule>;

bool all(Vec2) {
  return true;
}

// The unit disk: segment 0 above, of marker 1, segment 1 below, of marker 2.
Drawing disk(int above, int below) {
  Drawing drawing;
  drawing.arc({0, 0}, 1, 0, 180, above, 1).arc({0, 0}, 1, 180, 360, below, 2).vertex({0, 0});
  return drawing;
}

void expect_chains(const Problem& problem, const std::string& sentence) {
  const Report report = problem.check();
  EXPECT_NE(sentences(report, Rule::kChains).find(sentence), std::string::npos) << sentence << "\n"
                                                                                << to_text(report);
}

TEST(ArcRules, AVertexOffItsArcIsAViolation) {
  for (const double off : {1e-9, -1e-9, 1e-11}) {
    Problem problem = disk(6, 6).mesh(all);
    ASSERT_TRUE(problem.check().ok()) << to_text(problem.check());
    const std::uint32_t v = vertex_near(problem.mesh, on_circle({0, 0}, 1, 240));
    problem.mesh.vertices[v] = on_circle({0, 0}, 1 + off, 240);
    expect_chains(problem, "segment 1: no chain of listed edges along its arc from ");
    expect_chains(problem, "; vertex " + std::to_string(v) + " at ");
  }
}

TEST(ArcRules, AnEdgeThatTurnsByMoreThan60DegreesIsAViolation) {
  EXPECT_TRUE(disk(3, 3).mesh(all).check().ok());
  const Problem problem = disk(2, 3).mesh(all);
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kChains});
  expect_chains(problem, "segment 0: the edge (1, 0) from ");
  expect_chains(problem, " to (1, 0) turns by 90 degrees, more than 60");
}

TEST(ArcRules, AnEdgeThatBendsAnotherWayThanItsArcIsAViolation) {
  Problem problem = disk(6, 6).mesh(all);
  check::Mesh& mesh = problem.mesh;
  for (const Mesh::Edge& edge : mesh.edges) {
    const Vec2 p = mesh.vertices[edge.a], q = mesh.vertices[edge.b];
    mesh.bulges.push_back(std::copysign(std::tan(std::acos(-1.0) / 24), p.x * q.y - p.y * q.x));
  }
  EXPECT_TRUE(problem.check().ok()) << to_text(problem.check());
  mesh.bulges[2] *= -1;
  expect_chains(problem, " bends through ");
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kChains});
  mesh.bulges[2] = 0;
  expect_chains(problem, "the middle of its arc is ");
  mesh.bulges.pop_back();
  EXPECT_EQ(violated(problem.check()).count(Rule::kStructure), 1u);
}

TEST(ArcRules, AStraightEdgeThatBendsIsAViolation) {
  Drawing drawing = disk(6, 6);
  drawing.line({{-1, 0}, {0, 0}}).line({{0, 0}, {1, 0}});
  Problem problem = drawing.mesh(all);
  ASSERT_TRUE(problem.check().ok()) << to_text(problem.check());
  for (const Mesh::Edge& edge : problem.mesh.edges) {
    const Vec2 p = problem.mesh.vertices[edge.a], q = problem.mesh.vertices[edge.b];
    const double turn = p.x * q.y - p.y * q.x;
    problem.mesh.bulges.push_back(turn == 0 ? 0.01
                                            : std::copysign(std::tan(std::acos(-1.0) / 24), turn));
  }
  expect_chains(problem, " is on no arc, but bends through ");
}

TEST(ArcRules, AnArcThatIsAStraightEdgeIsAViolation) {
  Problem problem = disk(6, 6).mesh(all);
  // A sector of the lower half disk: its arc is a single edge now.
  problem.domain.points.push_back(on_circle({0, 0}, 1, 210));
  problem.domain.segments[1] = {2, 0};
  problem.domain.arcs[1].bulge = std::tan(std::acos(-1.0) * 5 / 6 / 4);
  problem.domain.segments.push_back({1, 2});
  problem.domain.markers.push_back(2);
  EXPECT_TRUE(problem.check().ok()) << "30 degrees, as a segment: " << to_text(problem.check());
  problem.domain.arcs.push_back({2, 1});  // a half circle
  expect_chains(problem, "segment 2: the edge ");
  expect_chains(problem, "turns by 180 degrees");
}

TEST(ArcRules, AVertexBetweenAnEdgeAndItsArcIsAViolation) {
  // Below the lower side of a square of 2, whose upper side is a flat arc.
  Drawing drawing;
  drawing.line({{-1, 1}, {-1, -1}}).line({{-1, -1}, {1, -1}}).line({{1, -1}, {1, 1}});
  const double half = 25, radius = 1 / std::sin(half * std::acos(-1.0) / 180);
  const Vec2 centre{0, 1 - std::sqrt(radius * radius - 1)};
  drawing.arc(centre, radius, 90 - half, 90 + half, 1);
  // A square on top of it, with its lower corner in the cap.
  const double in_cap = 1.1;
  drawing.line({{0, in_cap}, {1, 3}}).line({{1, 3}, {-1, 3}}).line({{-1, 3}, {0, in_cap}});
  const Problem problem = drawing.mesh([](Vec2 p) { return p.y < 1 || p.y > 1.8; });
  const Report report = problem.check();
  const std::string apex =
      "vertex " + std::to_string(vertex_near(problem.mesh, {0, in_cap})) + " at (0, 1.1)";
  expect_chains(problem, "segment 3: " + apex + " lies between the edge (");
  expect_chains(problem, "segment 3: the listed edge (");
  EXPECT_EQ(violated(report), Rules{Rule::kChains}) << to_text(report);
}

// The disk, and a line that crosses its arc twice between 60 and 90 degrees, but not the edge
// there.
struct Grazed {
  static Drawing disk() {
    Drawing drawing;
    drawing.arc({0, 0}, 1, 30, 150, 4, 1).arc({0, 0}, 1, 150, 390, 8, 2).vertex({0, 0});
    return drawing;
  }
  static Vec2 on_line(double along) {
    const double above = std::cos(std::acos(-1.0) / 12) + 0.01;
    const Vec2 p = on_circle({0, 0}, above, 75), q = on_circle({0, 0}, 1, 165);
    return {p.x + along * q.x, p.y + along * q.y};
  }
};

TEST(ArcRules, AChainThatLeavesACrossingOutIsAViolation) {
  const Vec2 a = Grazed::on_line(0.4), b = Grazed::on_line(-0.4), c = on_circle({0, 0}, 2, 75);
  Drawing drawing = Grazed::disk();
  drawing.line({a, b}).line({b, c}).line({c, a});
  const auto left_of = [](Vec2 p, Vec2 q, Vec2 at) {
    return (q.x - p.x) * (at.y - p.y) > (q.y - p.y) * (at.x - p.x);
  };
  const Problem problem = drawing.mesh([&](Vec2 p) {
    return std::hypot(p.x, p.y) < 0.9 ||
           (left_of(b, a, p) == left_of(b, a, c) && left_of(a, c, p) == left_of(a, c, b) &&
            left_of(c, b, p) == left_of(c, b, a));
  });
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kChains}) << to_text(problem.check());
  expect_chains(problem, "segment 0: the listed edge (");
}

TEST(ArcRules, ACrossingWithWhatIsNotMeshedIsNotLeftOutEither) {
  Drawing drawing = Grazed::disk();
  ASSERT_TRUE(drawing.mesh(all).check().ok());
  drawing.unmeshed_line(Grazed::on_line(-0.4), Grazed::on_line(0.4));
  EXPECT_EQ(violated(drawing.mesh(all).check()), Rules{Rule::kChains});
  expect_chains(drawing.mesh(all),
                "segment 0: no vertex where it meets segment 2, beside the edge (");
  // So it is with an arc that the mesh has none of.
  Drawing arcs = Grazed::disk();
  arcs.arc(on_circle({0, 0}, 1.5, 75), 0.51, 165, 345, 0);
  EXPECT_EQ(violated(arcs.mesh(all).check()), Rules{Rule::kChains});
  expect_chains(arcs.mesh(all), "segment 0: no vertex where it meets segment 2, beside the edge (");
  Drawing apart = Grazed::disk();
  apart.arc(on_circle({0, 0}, 1.5, 75), 0.499, 165, 345, 0);
  EXPECT_TRUE(apart.mesh(all).check().ok()) << to_text(apart.mesh(all).check());
}

TEST(ArcRules, EdgesThatAreTooLongBesideEachOtherAreAViolation) {
  // Two disks that nearly touch: their edges do not, but the triangles over these do.
  const auto two = [](double gap, int pieces) {
    Drawing drawing;
    for (const double x : {-1 - gap / 2, 1 + gap / 2}) {
      const double turned = x < 0 ? 0 : 180;
      const double half = 180.0 / pieces;
      drawing.arc({x, 0}, 1, turned + half, turned + half + 180, pieces / 2, 1);
      drawing.arc({x, 0}, 1, turned + half + 180, turned + half + 360, pieces / 2, 2);
      drawing.vertex({x, 0});
    }
    return drawing.mesh(
        [=](Vec2 p) { return std::hypot(std::fabs(p.x) - 1 - gap / 2, p.y) < 0.9; });
  };
  EXPECT_TRUE(two(0.1, 12).check().ok()) << to_text(two(0.1, 12).check());
  EXPECT_EQ(violated(two(0.001, 12).check()), Rules{Rule::kChains});
  expect_chains(two(0.001, 12), "are too long to keep their arcs apart");
  EXPECT_TRUE(two(0.001, 120).check().ok()) << to_text(two(0.001, 120).check());
}

TEST(ArcRules, AWrongMarkerIsAViolationOfMarkersAlone) {
  Problem problem = disk(6, 6).mesh(all);
  problem.mesh.edges[3].marker = 2;
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kMarkers});
  EXPECT_NE(sentences(report, Rule::kMarkers).find("has the marker 2, its segment has 1"),
            std::string::npos);
}

TEST(ArcRules, AnEdgeThatIsNotListedIsAViolation) {
  Problem problem = disk(6, 6).mesh(all);
  problem.mesh.edges.erase(problem.mesh.edges.begin() + 8);
  EXPECT_TRUE(violated(problem.check()).contains(Rule::kEdges));
  expect_chains(problem, "segment 1: no chain of listed edges along its arc");
}

TEST(ArcRules, AnInnerEdgeThatIsNotListedIsAViolation) {
  Drawing drawing;
  drawing.line({{-2, -2}, {2, -2}}).line({{2, -2}, {2, 2}}).line({{2, 2}, {-2, 2}});
  drawing.line({{-2, 2}, {-2, -2}}).arc({0, 0}, 1, 0, 90, 3, 1).vertex({-1, -1});
  Problem problem = drawing.mesh(all);
  ASSERT_TRUE(problem.check().ok()) << to_text(problem.check());
  problem.mesh.edges.pop_back();
  const Report report = problem.check();
  EXPECT_TRUE(violated(report).contains(Rule::kChains));
  expect_chains(problem, "segment 4: no chain of listed edges along its arc");
}

TEST(ArcRules, AMissingCapIsAViolationOfCoverageToo) {
  // The upper half of the disk is meshed to its diameter only.
  Drawing drawing;
  drawing.line({{-1, 0}, {0, 0}, {1, 0}}).arc({0, 0}, 1, 180, 360, 6, 2);
  Problem problem = drawing.mesh(all);
  problem.domain.segments[0] = {1, 0};
  problem.domain.arcs.push_back({0, 1});
  const Report report = problem.check();
  EXPECT_TRUE(violated(report).contains(Rule::kCoverage)) << to_text(report);
  expect_chains(problem, "segment 0: no chain of listed edges along its arc");
}

}  // namespace
}  // namespace weft::check::testing
