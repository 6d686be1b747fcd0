// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/domain/predicates.h"

#include <gtest/gtest.h>

#include <cmath>

namespace weft {
namespace {

TEST(Orientation, TellsLeftRightAndCollinearApart) {
  EXPECT_EQ(orientation_exact({0, 0}, {1, 0}, {0, 1}), 1);
  EXPECT_EQ(orientation_exact({0, 0}, {0, 1}, {1, 0}), -1);
  EXPECT_EQ(orientation_exact({0, 0}, {1, 1}, {3, 3}), 0);
}

TEST(Orientation, SeesOneUlpWhereRoundedArithmeticDoesNot) {
  const Point a{12, 12}, b{24, 24};
  const double half = 0.5;
  const double above = std::nextafter(half, 1.0);
  EXPECT_EQ(orientation_exact(a, b, {half, half}), 0);
  EXPECT_EQ(orientation_exact(a, b, {half, above}), 1);
  EXPECT_EQ(orientation_exact(a, b, {above, half}), -1);
}

TEST(Orientation, HoldsAtTheLimitsOfCoordinates) {
  EXPECT_EQ(orientation_exact({-1e100, -1e100}, {1e100, 1e100}, {1e-100, 0}), -1);
  EXPECT_EQ(orientation_exact({-1e-100, 0}, {1e-100, 0}, {0, 1e-100}), 1);
}

TEST(InCircle, ExcludesTheCircleItself) {
  const Point a{0, 0}, b{1, 0}, c{0, 1};
  EXPECT_TRUE(in_circle_exact(a, b, c, {0.5, 0.5}));
  EXPECT_FALSE(in_circle_exact(a, b, c, {1, 1}));
  EXPECT_FALSE(in_circle_exact(a, b, c, {2, 2}));
}

TEST(InCircle, SeesOneUlp) {
  const Point a{0, 0}, b{1, 0}, c{0, 1};
  EXPECT_TRUE(in_circle_exact(a, b, c, {1, std::nextafter(1.0, 0.0)}));
  EXPECT_FALSE(in_circle_exact(a, b, c, {1, std::nextafter(1.0, 2.0)}));
}

TEST(InCircle, HoldsAtTheLimitsOfCoordinates) {
  EXPECT_TRUE(in_circle_exact({0, 0}, {1e100, 0}, {0, 1e100}, {1e-100, 1e-100}));
  EXPECT_FALSE(in_circle_exact({0, 0}, {1e100, 0}, {0, 1e100}, {-1e-100, 0}));
}

}  // namespace
}  // namespace weft
