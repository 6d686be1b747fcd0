// SPDX-License-Identifier: Apache-2.0
#include "checker/size/distance_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace weft::check {
namespace {

// A polygon with n corners on a circle around the origin.
DistanceField circle(std::uint32_t n, double radius) {
  DistanceField field;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    field.points.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    field.segments.push_back({i, (i + 1) % n});
  }
  return field;
}

std::string error_of(const DistanceField& field, const Domain& domain = {}) {
  const auto made = Distance::make(field, domain);
  return made ? "" : made.error();
}

TEST(CheckersDistanceField, OfACircleOfSegmentsHasItsClosedForm) {
  constexpr std::uint32_t kCorners = 1000;
  const double inner = 3 * std::cos(std::numbers::pi / kCorners);
  const Distance distance = *Distance::make(circle(kCorners, 3), {});
  for (std::uint32_t i = 0; i < kCorners; ++i) {
    const double at_corner = 2 * std::numbers::pi * i / kCorners;
    const double at_middle = at_corner + std::numbers::pi / kCorners;
    EXPECT_NEAR(distance({5 * std::cos(at_corner), 5 * std::sin(at_corner)}), 2, 1e-14);
    EXPECT_NEAR(distance({5 * std::cos(at_middle), 5 * std::sin(at_middle)}), 5 - inner, 1e-14);
    EXPECT_NEAR(distance({std::cos(at_middle), std::sin(at_middle)}), inner - 1, 1e-14);
  }
  EXPECT_NEAR(distance({0, 0}), inner, 1e-15);
}

TEST(CheckersDistanceField, IsTheLeastOfAllSegments) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(-1, 1);
  DistanceField field;
  for (std::uint32_t i = 0; i < 300; ++i) {
    const Vec2 p{place(random), place(random)};
    field.points.push_back(p);
    field.points.push_back({p.x + 0.1 * place(random), p.y + 0.1 * place(random)});
    field.segments.push_back({2 * i, 2 * i + 1});
  }
  const Distance distance = *Distance::make(field, {});
  for (int k = 0; k < 2000; ++k) {
    const Vec2 p{2 * place(random), 2 * place(random)};
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [a, b] : field.segments) {
      const Vec2 u = field.points[a], v = field.points[b];
      const double square = std::pow(v.x - u.x, 2) + std::pow(v.y - u.y, 2);
      const double t = ((p.x - u.x) * (v.x - u.x) + (p.y - u.y) * (v.y - u.y)) / square;
      const double s = t < 0 ? 0 : t > 1 ? 1 : t;
      least = std::min(least, std::hypot(p.x - u.x - s * (v.x - u.x), p.y - u.y - s * (v.y - u.y)));
    }
    EXPECT_NEAR(distance(p), least, 1e-14);
  }
}

TEST(CheckersDistanceField, KeepsItsDigitsNearALongSegmentFarAway) {
  const Distance distance =
      *Distance::make({{}, {{1e6, 2e6}, {1e6 + 4e6, 2e6 + 3e6}}, {{0, 1}}}, {});
  // Half way, and 2^-10 to the side.
  const double side = 0x1p-10;
  const Vec2 p{3e6 - 0.6 * side, 3.5e6 + 0.8 * side};
  const long double exact = (4e6L * (p.y - 2e6L) - 3e6L * (p.x - 1e6L)) / 5e6L;
  EXPECT_NEAR(distance(p), static_cast<double>(exact), 1e-9 * side);
}

TEST(CheckersDistanceField, IsToThePointsIfThereAreNoSegments) {
  const Distance distance = *Distance::make({{}, {{0, 0}, {4, 0}}, {}}, {});
  EXPECT_EQ(distance({2, 0}), 2);
  EXPECT_EQ(distance({4, 3}), 3);
}

TEST(CheckersDistanceField, IsToTheMarkersOfTheDomain) {
  Domain domain;
  domain.points = {{0, 0}, {10, 0}, {10, 10}};
  domain.segments = {{0, 1}, {1, 2}};
  domain.markers = {2, 3};
  EXPECT_EQ((*Distance::make({}, domain))({9, 3}), 1);
  EXPECT_EQ((*Distance::make({{2}, {}, {}}, domain))({9, 3}), 3);
  EXPECT_EQ((*Distance::make({{3, 2}, {}, {}}, domain))({9, 3}), 1);
  EXPECT_EQ(error_of({{2, 7}, {}, {}}, domain), "no segment has the marker 7");
  domain.markers.clear();
  EXPECT_EQ((*Distance::make({{0}, {}, {}}, domain))({9, 3}), 1);
}

TEST(CheckersDistanceField, ToAnArcIsThatToItsPolyline) {
  Domain domain;
  domain.points = {{3, 0}, {-3, 0}};
  domain.segments = {{0, 1}, {1, 0}};
  domain.markers = {1, 2};
  domain.arcs = {{0, 1}};
  const double inner = 3 * std::cos(std::numbers::pi / 180);
  EXPECT_NEAR((*Distance::make({{1}, {}, {}}, domain))({0, 0}), inner, 1e-14);
  EXPECT_NEAR((*Distance::make({{1}, {}, {}}, domain))({0, 5}), 2, 1e-14);
  EXPECT_NEAR((*Distance::make({{2}, {}, {}}, domain))({0, 5}), 5, 1e-14);
  EXPECT_NEAR((*Distance::make({{1}, {}, {}}, domain))({0, -4}), 5, 1e-14);
  domain.arcs = {{0, -1}, {7, 1}};
  EXPECT_NEAR((*Distance::make({{1}, {}, {}}, domain))({0, 5}), std::hypot(3, 5), 1e-14);
}

TEST(CheckersDistanceField, OfNonsenseIsRefused) {
  EXPECT_EQ(error_of({}), "there is nothing to measure to");
  EXPECT_EQ(error_of({{}, {{0, 0}, {1, 1}}, {{0, 2}}}), "segment 0 joins points 0 and 2 of 2");
  EXPECT_EQ(error_of({{}, {}, {{0, 0}}}), "segment 0 joins points 0 and 0 of 0");
  EXPECT_EQ(error_of({{}, {{0, 0}, {std::nan(""), 1}}, {}}), "point 1 is (nan, 1)");
  Domain domain;
  domain.points = {{0, 0}};
  domain.segments = {{0, 4000000000u}};
  EXPECT_NE(error_of({}, domain), "");
  EXPECT_EQ((*Distance::make({{}, {{1, 1}}, {{0, 0}}}, {}))({1, 3}), 2);
}

}  // namespace
}  // namespace weft::check
