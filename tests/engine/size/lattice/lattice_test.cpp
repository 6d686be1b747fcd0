// SPDX-License-Identifier: Apache-2.0
#include "engine/size/lattice/lattice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "engine/size/lattice/conformal_map.h"
#include "engine/size/lattice/harmonic_fit.h"

namespace weft {
namespace {

double unit(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

TEST(Lattice, GivesThePointThatIsNearest) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 10'000; ++i) {
    const Complex w{200 * unit(random) - 100, 200 * unit(random) - 100};
    double nearest2 = std::numeric_limits<double>::infinity();
    const double row = std::floor(w.im / std::sqrt(0.75));
    for (double j = row - 2; j <= row + 2; ++j) {
      for (double k = std::floor(w.re) - 2; k <= w.re + 2; ++k) {
        const double shift = std::fmod(std::fabs(j), 2) == 1 ? 0.5 : 0;
        nearest2 = std::min(nearest2, norm2(Complex{k + shift, j * std::sqrt(0.75)} - w));
      }
    }
    EXPECT_NEAR(norm2(nearest_of_lattice(w, 0) - w), nearest2, 1e-9);
  }
}

TEST(Lattice, MovesAPointByItsJitterTheSameFromAllSides) {
  constexpr double kJitter = 0.01;
  std::mt19937_64 random(2);
  double most = 0;
  for (int i = 0; i < 1000; ++i) {
    const Complex w{200 * unit(random) - 100, 200 * unit(random) - 100};
    const Complex exact = nearest_of_lattice(w, 0);
    const Complex moved = nearest_of_lattice(w, kJitter);
    most = std::max({most, std::fabs(moved.re - exact.re), std::fabs(moved.im - exact.im)});
    for (const Complex beside : {Complex{0.3, 0}, Complex{-0.2, 0.2}, Complex{0, -0.3}}) {
      const Complex again = nearest_of_lattice(exact + beside, kJitter);
      EXPECT_EQ(again.re, moved.re);
      EXPECT_EQ(again.im, moved.im);
    }
  }
  EXPECT_LE(most, kJitter * (1 + 1e-9));
  EXPECT_GT(most, 0.9 * kJitter);
}

TEST(Lattice, IsThereUpTo31AndAHalfDegrees) {
  EXPECT_TRUE(LatticeShape::for_angle(0).exists());
  EXPECT_TRUE(LatticeShape::for_angle(31.5).exists());
  EXPECT_FALSE(LatticeShape::for_angle(31.6).exists());
  EXPECT_LT(LatticeShape::for_angle(20).jitter, LatticeShape::for_angle(30).jitter);
}

TEST(UniformLattice, HasNoPointForWhatIsNoSize) {
  const LatticeShape shape = LatticeShape::for_angle(20);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bound : {0.0, -1.0, infinity, std::nan(""), 1e-320, 1e300})
    EXPECT_EQ(UniformLattice().nearest({1, 1}, bound, shape).spacing2, 0) << bound;
  EXPECT_EQ(UniformLattice().nearest({1e40, 1}, 1, shape).spacing2, 0);
  EXPECT_EQ(UniformLattice().nearest({std::nan(""), 1}, 1, shape).spacing2, 0);
  EXPECT_NEAR(UniformLattice().nearest({1, 1}, 1, shape).spacing2, shape.area_ratio / kEquilateral,
              1e-9);
}

// U = u_1 zeta + u_2 zeta^2 + u_3 zeta^3 about (5, 7), radius 2, for edges of exp(Re U) / 100.
struct Bent {
  Bent() {
    u[0] = {std::log(0.01), 0};
    u[1] = {0.3, 0.1};
    u[2] = {-0.05, 0.1};
    u[3] = {0.02, 0.02};
    map = ConformalMap(kCentre, kRadius, u, 1);
  }
  double edge(Point p) const {
    const Complex zeta{(p.x - kCentre.x) / kRadius, (p.y - kCentre.y) / kRadius};
    Complex sum = u[3];
    for (std::size_t k = 3; k-- > 0;) sum = sum * zeta + u[k];
    return std::exp(sum.re);
  }
  Point random_point(std::mt19937_64& random) const {
    const double reach = kRadius / std::sqrt(2.0);
    return {kCentre.x + reach * (2 * unit(random) - 1), kCentre.y + reach * (2 * unit(random) - 1)};
  }

  static constexpr Point kCentre{5, 7};
  static constexpr double kRadius = 2;
  ConformalMap::Exponent u{};
  ConformalMap map;
};

TEST(ConformalMap, StretchesByOneOverTheEdge) {
  const Bent bent;
  std::mt19937_64 random(3);
  for (int i = 0; i < 1000; ++i) {
    const Point p = bent.random_point(random);
    EXPECT_NEAR(modulus(bent.map.at(p).slope) * bent.edge(p), 1, 1e-4);
    EXPECT_NEAR(std::sqrt(bent.map.nearest(p, 0).spacing2), bent.edge(p), 1e-4 * bent.edge(p));
  }
}

TEST(ConformalMap, GivesPointsThatItMapsToTheLattice) {
  const Bent bent;
  std::mt19937_64 random(4);
  for (int i = 0; i < 1000; ++i) {
    const Point p = bent.random_point(random);
    const Point q = bent.map.nearest(p, 0).at;
    const Complex w = bent.map.at(q).w;
    EXPECT_LT(modulus(nearest_of_lattice(w, 0) - w), 1e-4);
    EXPECT_LT(std::hypot(q.x - p.x, q.y - p.y), 0.6 * bent.edge(p));
  }
}

TEST(ConformalMap, KeepsItsPointsWhenTheLatticeIsTurnedAndShiftedOntoItself) {
  Bent bent;
  const ConformalMap before = bent.map;
  bent.map.move({0.5, std::sqrt(0.75)}, {7, 0});
  std::mt19937_64 random(5);
  for (int i = 0; i < 100; ++i) {
    const Point p = bent.random_point(random);
    const Point one = before.nearest(p, 0).at;
    const Point other = bent.map.nearest(p, 0).at;
    EXPECT_LT(std::hypot(one.x - other.x, one.y - other.y), 1e-4 * bent.edge(p));
  }
}

TEST(ConformalMap, HasNoPointOutsideOfItsDisk) {
  const Bent bent;
  EXPECT_GT(bent.map.nearest({6.4, 8.4}, 0).spacing2, 0);
  EXPECT_EQ(bent.map.nearest({7.1, 7}, 0).spacing2, 0);
  EXPECT_EQ(bent.map.nearest({1e300, 7}, 0).spacing2, 0);
  EXPECT_EQ(bent.map.nearest({std::nan(""), 7}, 0).spacing2, 0);
}

template <class Fitter = FineFitter>
HarmonicFit fit_of(double (*edge)(double, double), Point centre, double half) {
  const Fitter fitter;
  typename Fitter::Samples edges;
  for (std::size_t s = 0; s < Fitter::kSamples; ++s) {
    const Point p = fitter.sample(s, centre, half);
    edges[s] = edge(p.x, p.y);
  }
  return fitter.fit(edges);
}

TEST(HarmonicFit, OfALogarithmThatIsHarmonicIsExact) {
  const HarmonicFit by_exponential =
      fit_of([](double x, double y) { return 0.1 * std::exp(0.3 * x - 0.2 * y); }, {3, 4}, 1);
  EXPECT_LT(by_exponential.deviation(), 1e-12);
  EXPECT_NEAR(by_exponential.u[1].re, 0.3 * std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(by_exponential.u[1].im, 0.2 * std::sqrt(2.0), 1e-12);
  const HarmonicFit by_distance =
      fit_of([](double x, double y) { return 0.1 * std::hypot(x, y); }, {3, 4}, 1);
  EXPECT_LT(by_distance.deviation(), 1e-4);
}

TEST(HarmonicFit, OfFewSamplesIsExactUpToItsDegree) {
  const auto cubic = [](double x, double y) {
    return std::exp(0.1 * x - 0.2 * y + 0.03 * (x * x - y * y) +
                    0.02 * (x * x * x - 3 * x * y * y));
  };
  EXPECT_LT(fit_of<CoarseFitter>(cubic, {3, 4}, 1).deviation(), 1e-12);
  const auto quartic = [](double x, double y) {
    return std::exp(0.1 * (x * x * x * x - 6 * x * x * y * y + y * y * y * y));
  };
  EXPECT_GT(fit_of<CoarseFitter>(quartic, {0, 0}, 1).deviation(), 0.01);
  EXPECT_LT(fit_of(quartic, {0, 0}, 1).deviation(), 1e-12);
}

TEST(HarmonicFit, OfALogarithmThatIsNotHarmonicTellsItsDeviation) {
  // log h = c (x^2 + y^2) is off by what its Laplacian makes: a quarter of it times a radius.
  const HarmonicFit fit =
      fit_of([](double x, double y) { return std::exp(0.1 * (x * x + y * y)); }, {0, 0}, 1);
  EXPECT_GT(fit.deviation(), 0.05);
  EXPECT_LT(fit.deviation(), 0.2);
  EXPECT_GE(fit.above, 0);
  EXPECT_LE(fit.below, 0);
}

}  // namespace
}  // namespace weft
