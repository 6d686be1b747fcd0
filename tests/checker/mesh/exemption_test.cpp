// SPDX-License-Identifier: Apache-2.0
// Rule 6: which small angles a small input angle exempts.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "checker/geometry/predicates.h"
#include "tests/checker/lattice.h"

namespace weft::check::testing {
namespace {

using Rules = std::set<Rule>;

// A wedge at the origin with sides of length 2, cut at `low` on the lower and `high` on the upper
// side, as a mesh of three triangles.
Problem wedge(double degrees, double low, double high) {
  const double angle = degrees * std::acos(-1.0) / 180;
  const Vec2 direction{std::cos(angle), std::sin(angle)};
  Problem problem;
  problem.domain.points = {{0, 0}, {2, 0}, {2 * direction.x, 2 * direction.y}};
  problem.domain.segments = {{0, 1}, {1, 2}, {2, 0}};
  problem.mesh.vertices = problem.domain.points;
  problem.mesh.vertices.push_back({low, 0});
  problem.mesh.vertices.push_back({high * direction.x, high * direction.y});
  problem.mesh.triangles = {{0, 3, 4}, {3, 1, 4}, {1, 2, 4}};
  // A symmetric trapezoid's corners are on a circle, but for rounding.
  const std::vector<Vec2>& v = problem.mesh.vertices;
  if (in_circle(v[3], v[1], v[4], v[2]) > 0)
    problem.mesh.triangles = {{0, 3, 4}, {3, 1, 2}, {3, 2, 4}};
  problem.mesh.edges = {{0, 3, 0}, {3, 1, 0}, {1, 2, 0}, {2, 4, 0}, {4, 0, 0}};
  problem.requirements.min_angle_deg = 20;
  return problem;
}

TEST(Exemption, TheCornerAndTheShellsOfASmallInputAngleAreExempt) {
  const Report report = wedge(10, 1, 1).check();
  EXPECT_TRUE(report.ok()) << to_text(report);
  EXPECT_EQ(report.facts.exempt_corner, 1u);
  EXPECT_EQ(report.facts.exempt_shell, 2u);
  EXPECT_EQ(report.facts.unrefined, 0u);
}

TEST(Exemption, NothingIsExemptWhereItIsNotAllowed) {
  Problem problem = wedge(10, 1, 1);
  problem.requirements.allow_small_input_angles = false;
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kAngle});
  EXPECT_EQ(report.total(Rule::kAngle), 3u);
}

TEST(Exemption, PointsAtUnequalDistanceAreNoShell) {
  const Report report = wedge(10, 1, 1.05).check();
  EXPECT_TRUE(violated(report).contains(Rule::kAngle)) << to_text(report);
}

TEST(Exemption, DistancesAreTheSameToWithinRounding) {
  EXPECT_EQ(wedge(10, 1, 1 + 0x1p-46).check().facts.exempt_shell, 2u);
  const Report report = wedge(10, 1, 1 + 0x1p-43).check();
  EXPECT_TRUE(violated(report).contains(Rule::kAngle)) << to_text(report);
}

TEST(Exemption, AnInputAngleAboveTheBoundNeedsNoExemption) {
  const Report report = wedge(30, 1, 1).check();
  EXPECT_EQ(report.facts.exempt_corner, 0u);
}

TEST(Exemption, ASkinnyTriangleAwayFromSegmentsHasNone) {
  // A square with a needle in its middle.
  Problem problem;
  problem.domain.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  problem.domain.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  problem.mesh.vertices = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0.499}, {0.5, 0.501}};
  problem.mesh.triangles = {{0, 1, 4}, {1, 5, 4}, {1, 2, 5}, {2, 3, 5}, {3, 4, 5}, {3, 0, 4}};
  problem.mesh.edges = {{0, 1, 0}, {1, 2, 0}, {2, 3, 0}, {3, 0, 0}};
  problem.requirements.min_angle_deg = 20;
  const Report report = problem.check();
  EXPECT_TRUE(violated(report).contains(Rule::kAngle)) << to_text(report);
  EXPECT_EQ(report.facts.exempt_corner + report.facts.exempt_shell, 0u);
}

TEST(Exemption, AWideInputAngleExemptsNothing) {
  // The short edge joins two sides of a right angle at equal distance from it.
  Problem problem;
  problem.domain.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  problem.domain.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  problem.mesh.vertices = problem.domain.points;
  problem.mesh.vertices.insert(problem.mesh.vertices.end(), {{0.125, 0}, {0, 0.125}});
  problem.mesh.triangles = {{0, 4, 5}, {4, 2, 5}, {4, 1, 2}, {5, 2, 3}};
  problem.mesh.edges = {{0, 4, 0}, {4, 1, 0}, {1, 2, 0}, {2, 3, 0}, {3, 5, 0}, {5, 0, 0}};
  problem.requirements.min_angle_deg = 20;
  const Report report = problem.check();
  EXPECT_EQ(violated(report), Rules{Rule::kAngle}) << to_text(report);
  EXPECT_EQ(report.total(Rule::kAngle), 1u);
}

TEST(Exemption, SegmentsThatCrossExemptToo) {
  // Two lines through (1, 0), which is no input point, 10 degrees apart; the mesh is the hourglass.
  const double slope = std::tan(5 * std::acos(-1.0) / 180);
  Problem problem;
  problem.domain.points = {{0, -slope}, {2, slope}, {2, -slope}, {0, slope}};
  problem.domain.segments = {{0, 1}, {2, 3}, {2, 1}, {3, 0}};
  problem.mesh.vertices = problem.domain.points;
  problem.mesh.vertices.push_back({1, 0});
  problem.mesh.triangles = {{4, 2, 1}, {4, 3, 0}};
  problem.mesh.edges = {{0, 4, 0}, {4, 1, 0}, {2, 4, 0}, {4, 3, 0}, {2, 1, 0}, {3, 0, 0}};
  problem.requirements.min_angle_deg = 20;
  const Report report = problem.check();
  EXPECT_TRUE(report.ok()) << to_text(report);
  EXPECT_EQ(report.facts.exempt_corner, 2u);
}

}  // namespace
}  // namespace weft::check::testing
