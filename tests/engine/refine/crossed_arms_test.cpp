// SPDX-License-Identifier: Apache-2.0
#include "engine/refine/crossed_arms.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "engine/engine.h"
#include "engine/refine/acute_corners.h"
#include "tests/engine/domain/shapes.h"
#include "tests/engine/refine/random_pslg.h"
#include "tests/engine/refine/sound.h"

namespace weft {
namespace {

// Two arms from the corner (0, 0), 10 long, seen at this tangent; segments across at each x; a box
// around all.
Pslg crossed_wedge(double tangent, const std::vector<double>& across) {
  Pslg pslg;
  add_box(pslg, {-5, -5}, {15, 5});
  add_segment(pslg, {0, 0}, {10, 0});
  add_segment(pslg, {0, 0}, {10, 10 * tangent});
  for (const double x : across) add_segment(pslg, {x, -1}, {x, 2});
  return pslg;
}

struct Found {
  Domain domain;
  CrossedArms arms;

  std::uint32_t subsegment(Point middle) const {
    for (std::uint32_t s = 0; s < domain.subsegments.size(); ++s) {
      const Point a = domain.vertices[domain.subsegments[s].a];
      const Point b = domain.vertices[domain.subsegments[s].b];
      if (std::fabs(a.x + b.x - 2 * middle.x) < 1e-9 && std::fabs(a.y + b.y - 2 * middle.y) < 1e-9)
        return s;
    }
    ADD_FAILURE() << "no subsegment about (" << middle.x << ", " << middle.y << ")";
    return 0;
  }
  // Of all arms of a subsegment, if it is one.
  std::optional<Point> corner(Point middle) const {
    std::optional<Point> corner;
    for (const CrossedArms::Arm& arm : arms.of(subsegment(middle))) {
      const Point at = domain.vertices[arm.corner];
      EXPECT_TRUE(!corner || (corner->x == at.x && corner->y == at.y));
      corner = at;
    }
    return corner;
  }
};

Found find(const Pslg& pslg) {
  const ExecutionContext context;
  Found found{*triangulate(pslg, context), {}};
  found.arms =
      AcuteCorners::build(found.domain, QualityBounds::from(20, 0, 1e-12), context)->crossed_arms();
  return found;
}

TEST(CrossedArms, KeepTheirCornerBeyondEachCrossing) {
  const Found found = find(crossed_wedge(1e-3, {2, 6}));
  for (const double x : {4.0, 8.0}) {
    for (const double y : {0.0, 1e-3 * x}) {
      const auto corner = found.corner({x, y});
      ASSERT_TRUE(corner) << x << ' ' << y;
      EXPECT_EQ(corner->x, 0);
      EXPECT_EQ(corner->y, 0);
    }
    EXPECT_TRUE(found.arms.share_corner(found.subsegment({x, 0}), found.subsegment({x, 1e-3 * x})));
  }
}

TEST(CrossedArms, AreNotKeptForTheirOwnEndsNorForWhatCrosses) {
  const Found found = find(crossed_wedge(1e-3, {2, 6}));
  EXPECT_FALSE(found.corner({1, 0}));
  EXPECT_FALSE(found.corner({1, 1e-3}));
  EXPECT_FALSE(found.corner({2, 1e-3}));
  EXPECT_FALSE(found.corner({2, -0.5}));
}

TEST(CrossedArms, OfWiderCornersAreNotKept) {
  const Found found = find(crossed_wedge(0.07, {2, 6}));
  EXPECT_FALSE(found.corner({4, 0}));
}

TEST(CrossedArms, KeepTheSharpestOfSeveralCorners) {
  Pslg pslg = crossed_wedge(1e-3, {6});
  add_segment(pslg, {2, 0}, {9, -0.1});  // a second corner on the first arm, at 1/70
  const auto corner = find(pslg).corner({8, 0});
  ASSERT_TRUE(corner);
  EXPECT_EQ(corner->x, 0);
}

TEST(CrossedArms, AreNotKeptPastTheEndOfTheOtherArm) {
  Pslg pslg = crossed_wedge(1e-3, {4, 7});
  pslg.points[pslg.segments[5].b] = {5, 5e-3};  // the second arm's end
  const Found found = find(pslg);
  EXPECT_TRUE(found.corner({5.5, 0}));  // past the second arm, and beside it
  EXPECT_FALSE(found.corner({8.5, 0}));
}

TEST(CrossedArms, KeepTheNextCornerPastTheSharpest) {
  Pslg pslg = crossed_wedge(1e-3, {4, 7});
  pslg.points[pslg.segments[5].b] = {5, 5e-3};
  add_segment(pslg, {2, 0}, {9, -0.1});  // a second corner on the first arm, at 1/70
  const Found found = find(pslg);
  EXPECT_EQ(found.corner({5.5, 0})->x, 0);
  EXPECT_EQ(found.corner({8.5, 0})->x, 2);
}

// Of two arms that end 1e-5 apart, 5 from their corner, and are crossed twice.
Pslg sliver(double offset) {
  Pslg pslg;
  for (const Point p : {Point{3e-6, 3.999996},
                        {0, 7.000002},
                        {2.999999, 8.000003},
                        {6.999996, 7},
                        {-4e-6, 4.000003}})
    pslg.points.push_back({p.x + offset, p.y + offset});
  pslg.segments = {{4, 3}, {3, 1}, {3, 0}, {2, 4}, {2, 0}};
  return pslg;
}

TEST(CrossedArms, CostALogarithmOfLengthOverWidth) {
  for (const double offset : {0.0, 1e6}) {
    for (const double degrees : {6.0, 20.0}) {
      const Sound made = sound({.pslg = sliver(offset), .min_angle_deg = degrees});
      EXPECT_LE(made.summary.triangles, 300u) << offset << ' ' << degrees;
      EXPECT_EQ(made.summary.unrefined.total(), made.summary.unrefined.small_input_angle);
    }
  }
}

TEST(CrossedArms, CostLittleHoweverTheyAreCrossed) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    const double tangent = std::pow(10, -2 - 5 * random.unit());
    const std::uint32_t crossings = 1 + random.below(4);
    const double turn = 6.28 * random.unit();
    const double offset = seed % 2 == 0 ? 0 : 1e3;
    const auto turned = [&](Point p) {
      return Point{offset + std::cos(turn) * p.x - std::sin(turn) * p.y,
                   offset + std::sin(turn) * p.x + std::cos(turn) * p.y};
    };
    Pslg pslg;
    for (const Point p : {Point{-20, -20}, {20, -20}, {20, 20}, {-20, 20}})
      pslg.points.push_back(turned(p));
    pslg.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    const double second = 8 + 4 * random.unit();
    add_segment(pslg, turned({0, 0}), turned({10, 0}));
    add_segment(pslg, turned({0, 0}), turned({second, second * tangent}));
    for (std::uint32_t i = 0; i < crossings; ++i) {
      const double x = 1 + 6 * random.unit();
      const double slant = 2 * random.unit() - 1;  // 45 degrees and more from the arms
      add_segment(pslg, turned({x - slant, -1}), turned({x + slant, 1}));
    }
    const double levels = (crossings + 1) * std::log2(1 / tangent);
    for (const auto& [degrees, most] : {std::pair{20.0, 15}, {30.0, 30}, {33.0, 45}}) {
      const Sound made = sound({.pslg = pslg, .min_angle_deg = degrees});
      EXPECT_LE(static_cast<double>(made.summary.triangles), 300 + most * levels)
          << seed << ' ' << degrees;
      EXPECT_EQ(made.summary.unrefined.total(), made.summary.unrefined.small_input_angle) << seed;
    }
  }
}

}  // namespace
}  // namespace weft
