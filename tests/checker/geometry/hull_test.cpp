// SPDX-License-Identifier: Apache-2.0
#include "checker/geometry/hull.h"

#include <gtest/gtest.h>

namespace weft::check::testing {
namespace {

const Hull kHull{{0, 0}, {4, 0}, {2, 2}};

TEST(ArcHull, HoldsWhatIsInItOrOnItsSides) {
  for (const Vec2 p : {Vec2{2, 1}, Vec2{2, 2}, Vec2{1, 1}, Vec2{2, 0}})
    EXPECT_TRUE(holds(kHull, p));
  for (const Vec2 p : {Vec2{0, 0}, Vec2{4, 0}, Vec2{2, -0.1}, Vec2{1, 1.1}, Vec2{-1, 0}})
    EXPECT_FALSE(holds(kHull, p));
}

TEST(ArcHull, MeetsEdgesThatCrossOrTouchIt) {
  EXPECT_TRUE(meet(kHull, {2, 1}, {2, 1.5}));
  EXPECT_TRUE(meet(kHull, {-1, 1}, {5, 1}));
  EXPECT_TRUE(meet(kHull, {2, 2}, {2, 9}));
  EXPECT_TRUE(meet(kHull, {0, 2}, {4, 2}));
  EXPECT_FALSE(meet(kHull, {0, 2.1}, {4, 2.1}));
  EXPECT_FALSE(meet(kHull, {-3, -1}, {5, -1}));
}

TEST(ArcHull, MeetsEdgesAtItsEndsThatRunIntoIt) {
  for (const Vec2 p : {Vec2{3, 1}, Vec2{8, 1}, Vec2{1, 1}, Vec2{3, 3}}) {
    EXPECT_TRUE(meet(kHull, {0, 0}, p));
    EXPECT_TRUE(meet(kHull, p, {0, 0}));
  }
  for (const Vec2 p : {Vec2{1, 1.1}, Vec2{-1, -1}, Vec2{-1, 0}, Vec2{1, -0.1}})
    EXPECT_FALSE(meet(kHull, {0, 0}, p));
  EXPECT_FALSE(meet(kHull, {4, 0}, {0, 0})) << "its own chord";
}

TEST(ArcHull, MeetsOtherHullsButForAnEnd) {
  EXPECT_TRUE(meet(kHull, Hull{{1, 3}, {3, 3}, {2, 1.9}}));
  EXPECT_FALSE(meet(kHull, Hull{{1, 3}, {3, 3}, {2, 2.1}}));
  EXPECT_TRUE(meet(kHull, Hull{{1.5, 1}, {2.5, 1}, {2, 1.5}}));
  EXPECT_TRUE(meet(Hull{{1.5, 1}, {2.5, 1}, {2, 1.5}}, kHull));
  EXPECT_FALSE(meet(kHull, Hull{{4, 0}, {6, -3}, {6, -1}})) << "the next on an arc";
  EXPECT_TRUE(meet(kHull, Hull{{0, 0}, {-1, 2}, {1, 0.5}})) << "the other's tangent is in it";
  EXPECT_TRUE(meet(kHull, Hull{{0, 0}, {5, -1}, {5, 9}})) << "it is in the other";
  EXPECT_FALSE(meet(kHull, Hull{{4, 0}, {0, 0}, {2, -2}})) << "of the same chord";
}

}  // namespace
}  // namespace weft::check::testing
