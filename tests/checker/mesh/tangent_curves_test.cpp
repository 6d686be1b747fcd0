// SPDX-License-Identifier: Apache-2.0
#include "checker/mesh/tangent_curves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/checker/drawing.h"

namespace weft::check::testing {
namespace {

bool all(Vec2) {
  return true;
}

void circle(Drawing& drawing, Vec2 centre, double radius, double first, double second) {
  drawing.arc(centre, radius, {0, first, second, 60, 90, 120, 150, 180});
  drawing.arc(centre, radius, {180, 210, 240, 270, 300, 360 - second, 360 - first, 360});
}

// The unit circle, and one through (1, 0) in it, with vertices at one distance from there.
Problem one_in_the_other(double radius, double turn) {
  Drawing drawing;
  circle(drawing, {0, 0}, 1, turn, 2 * turn);
  const auto inner = [&](double outer) {
    const double half = outer / 2 * (std::numbers::pi / 180);
    return 2 * std::asin(std::sin(half) / radius) * (180 / std::numbers::pi);
  };
  circle(drawing, {1 - radius, 0}, radius, inner(turn), inner(2 * turn));
  return drawing.mesh(all);
}

TEST(TangentCurves, OfCirclesThatTouchFromInsideHaveHullsThatMeet) {
  for (const double radius : {0.5, 0.7, 0.8}) {
    const Report report = one_in_the_other(radius, 12).check();
    EXPECT_TRUE(report.ok()) << to_text(report);
  }
}

TEST(TangentCurves, MayMeetNothingElse) {
  // The inner circle's centre is moved, so that it touches the other no more, but by 0.1 radians.
  Problem problem = one_in_the_other(0.8, 12);
  ASSERT_TRUE(problem.check().ok());
  Domain& domain = problem.domain;
  const std::uint32_t first = vertex_near(problem.mesh, {1, 0});
  domain.arcs[2].bulge = std::tan((std::numbers::pi - 0.2) / 4);
  domain.arcs[3].bulge = std::tan((std::numbers::pi + 0.2) / 4);
  EXPECT_FALSE(problem.check().ok()) << first;
}

TEST(TangentCurves, OfALineBesideACircle) {
  Drawing drawing;
  for (int k = 0; k < 4; ++k)
    drawing.line({on_circle({0, 0}, 3, 45 + 90 * k), on_circle({0, 0}, 3, 135 + 90 * k)});
  circle(drawing, {0, 0}, 1, 15, 30);
  drawing.line({{1, -1}, {1, -std::tan(0.26)}, {1, 0}, {1, std::tan(0.26)}, {1, 1}});
  const Report report = drawing.mesh(all).check();
  EXPECT_TRUE(report.ok()) << to_text(report);
}

TEST(TangentCurves, OfCirclesThatTouchFromOutside) {
  Drawing drawing;
  circle(drawing, {0, 0}, 1, 15, 30);
  drawing.vertex({0, 0}).arc({2, 0}, 1, 180, 0, 6).arc({2, 0}, 1, 180, 360, 6).vertex({2, 0});
  const Report report =
      drawing
          .mesh([](Vec2 p) { return std::hypot(p.x, p.y) < 0.9 || std::hypot(p.x - 2, p.y) < 0.9; })
          .check();
  EXPECT_TRUE(report.ok()) << to_text(report);
}

}  // namespace
}  // namespace weft::check::testing
