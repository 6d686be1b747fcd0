// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/biarcs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace weft::files {
namespace {

constexpr double kWholeTurn = 2 * std::numbers::pi;

Curve ellipse_curve(double a, double b) {
  return [=](double t) -> CurvePoint {
    return {{a * std::cos(t), b * std::sin(t)}, {-a * std::sin(t), b * std::cos(t)}};
  };
}

Curve cubic_curve(Point a, Point b, Point c, Point d) {
  return [=](double t) -> CurvePoint {
    const double s = 1 - t;
    const auto at = [&](double p, double q, double r, double u) {
      return s * s * s * p + 3 * s * s * t * q + 3 * s * t * t * r + t * t * t * u;
    };
    const auto along = [&](double p, double q, double r, double u) {
      return s * s * (q - p) + 2 * s * t * (r - q) + t * t * (u - r);
    };
    return {{at(a.x, b.x, c.x, d.x), at(a.y, b.y, c.y, d.y)},
            {along(a.x, b.x, c.x, d.x), along(a.y, b.y, c.y, d.y)}};
  };
}

ArcChain followed(const Curve& curve, double from, double to, int pieces, double extent) {
  ArcChain chain({curve(from).at});
  add_biarcs(curve, from, to, pieces, extent, chain);
  EXPECT_EQ(chain.points.size(), chain.bulges.size());
  EXPECT_EQ(chain.bulges.back(), 0);
  return chain;
}

// Of the nearest point of the chain.
double distance_to(const ArcChain& chain, Point p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < chain.points.size(); ++i) {
    const Point a = chain.points[i], b = chain.points[i + 1];
    const double chord = std::hypot(b.x - a.x, b.y - a.y);
    if (chord == 0) continue;
    // In the frame of the chord, from its middle.
    const Point u{(b.x - a.x) / chord, (b.y - a.y) / chord};
    const Point w{p.x - (a.x + b.x) / 2, p.y - (a.y + b.y) / 2};
    const Point q{w.x * u.x + w.y * u.y, w.y * u.x - w.x * u.y};
    const double bulge = chain.bulges[i];
    double gap = std::abs(q.y);
    bool is_beside = std::abs(q.x) <= chord / 2;
    if (std::abs(bulge) > 1e-9) {
      const double radius = chord * (1 + bulge * bulge) / (4 * std::abs(bulge));
      const double centre = chord * (1 - bulge * bulge) / (4 * bulge);
      gap = std::abs(std::hypot(q.x, q.y - centre) - radius);
      is_beside = is_beside || (q.y < 0) == (bulge > 0);
    }
    if (is_beside) least = std::min(least, gap);
    for (const Point end : {a, b}) least = std::min(least, std::hypot(p.x - end.x, p.y - end.y));
  }
  return least;
}

double greatest_distance(const ArcChain& chain, const Curve& curve, double from, double to) {
  double most = 0;
  for (int i = 0; i <= 3000; ++i)
    most = std::max(most, distance_to(chain, curve(from + (to - from) * i / 3000).at));
  return most;
}

// In radians, between a segment and the next.
double greatest_kink(const ArcChain& chain) {
  double most = 0;
  const auto direction_of = [&](std::size_t i, double turn) {
    const Point a = chain.points[i], b = chain.points[i + 1];
    return std::atan2(b.y - a.y, b.x - a.x) + turn * std::atan(chain.bulges[i]);
  };
  for (std::size_t i = 0; i + 2 < chain.points.size(); ++i)
    most = std::max(
        most, std::abs(std::remainder(direction_of(i + 1, -2) - direction_of(i, 2), kWholeTurn)));
  return most;
}

TEST(Biarcs, FollowAnEllipseSmoothlyByFewArcs) {
  for (const auto& [ratio, most] : {std::pair{1.1, 48u}, {2, 80u}, {10, 128u}, {100, 120u}}) {
    const Curve curve = ellipse_curve(ratio, 1);
    const ArcChain chain = followed(curve, 0, kWholeTurn, 4, 2 * ratio);
    EXPECT_LE(chain.points.size() - 1, most) << ratio;
    EXPECT_LE(greatest_distance(chain, curve, 0, kWholeTurn), 2e-5 * 2 * ratio) << ratio;
    EXPECT_LT(greatest_kink(chain), 1e-10) << ratio;
  }
}

TEST(Biarcs, OfACircleAreOneArcOfEachPiece) {
  const ArcChain chain = followed(ellipse_curve(3, 3), 0, kWholeTurn, 4, 6);
  ASSERT_EQ(chain.points.size(), 5u);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(chain.bulges[i], std::tan(kWholeTurn / 16), 1e-15);
}

TEST(Biarcs, OfALineAreOneStraightSegment) {
  const ArcChain chain = followed(cubic_curve({0, 0}, {1, 1}, {2, 2}, {3, 3}), 0, 1, 1, 3);
  EXPECT_EQ(chain.points, (std::vector<Point>{{0, 0}, {3, 3}}));
  EXPECT_EQ(chain.bulges[0], 0);
}

TEST(Biarcs, FollowCurvesThatBendBothWays) {
  struct Case {
    Curve curve;
    std::size_t most;
  };
  for (const auto& [curve, most] : {Case{cubic_curve({0, 0}, {1, 1}, {2, -1}, {3, 0}), 36},
                                    {cubic_curve({0, 0}, {1, 9}, {2, -9}, {3, 0}), 124},
                                    {cubic_curve({0, 0}, {2, 1}, {-1, 1}, {1, 0}), 80}}) {
    const ArcChain chain = followed(curve, 0, 1, 1, 3);
    EXPECT_LE(chain.points.size() - 1, most);
    EXPECT_LE(greatest_distance(chain, curve, 0, 1), 2e-5 * 3);
    EXPECT_LT(greatest_kink(chain), 1e-10);
    EXPECT_GT(std::ranges::max(chain.bulges), 0);
  }
}

TEST(Biarcs, AreNearerWhereTheRadiusIsSmall) {
  // A hundredth of the curve that they are part of.
  const Curve curve = ellipse_curve(0.01, 0.005);
  const ArcChain chain = followed(curve, 0, kWholeTurn, 4, 1);
  EXPECT_LE(greatest_distance(chain, curve, 0, kWholeTurn), 1e-4 * 0.02);
}

TEST(Biarcs, TurnBackAtACusp) {
  // The tangent is 0 at the cusp, which is no end of a piece; at one; at the first point.
  const auto cusp = [](double where) -> Curve {
    return [where](double t) -> CurvePoint {
      const double u = t - where;
      return {{u * u, u * u * u}, {2 * u, 3 * u * u}};
    };
  };
  for (const double where : {1.0 / 3, 0.5, 0.0}) {
    const ArcChain chain = followed(cusp(where), 0, 1, 1, 1);
    EXPECT_LE(chain.points.size(), 80u) << where;
    EXPECT_LE(greatest_distance(chain, cusp(where), 0, 1), 2e-5) << where;
  }
  // An ellipse without a width: from one end to the other and back.
  const ArcChain flat = followed(ellipse_curve(1, 0), 0, kWholeTurn, 4, 2);
  EXPECT_EQ(flat.points.size(), 5u);
  for (const double bulge : flat.bulges) EXPECT_EQ(bulge, 0);
}

TEST(Biarcs, AreFewWhateverTheCurve) {
  const auto count = [](const Curve& curve, double extent) {
    return followed(curve, 0, 1, 1, extent).points.size() - 1;
  };
  EXPECT_EQ(count(cubic_curve({1, 1}, {1, 1}, {1, 1}, {1, 1}), 0), 1u);
  EXPECT_EQ(count(cubic_curve({1, 1}, {1, 1}, {1, 1}, {1, 1}), 1), 1u);
  EXPECT_EQ(count(cubic_curve({0, 0}, {1e308, 0}, {-1e308, 1e308}, {1, 1}), 1), 1u);
  EXPECT_EQ(count([](double) { return CurvePoint{{std::nan(""), 0}, {1, 0}}; }, 1), 1u);
  // No tangent is the curve's, and no piece of it is smooth.
  const Curve saw = [](double t) -> CurvePoint {
    return {{t, std::fmod(t * 1e6, 1)}, {-1, std::fmod(t * 1e7, 2) - 1}};
  };
  EXPECT_LE(count(saw, 1), 2u * 4096);
  for (const double bulge : followed(saw, 0, 1, 1, 1).bulges) EXPECT_TRUE(std::isfinite(bulge));
}

}  // namespace
}  // namespace weft::files
