// SPDX-License-Identifier: Apache-2.0
#include "engine/size/lattice/lattice_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "engine/size/expression/expression.h"
#include "tests/engine/domain/shapes.h"

namespace weft {
namespace {

using Kind = LatticeMap::Kind;

struct LaidOut {
  explicit LaidOut(const std::string& text, const Pslg& pslg = square(8), Arena* arena = nullptr)
      : size(*Expression::parse(text)), domain(*triangulate(pslg, context)) {
    if (arena) context.set_arena(*arena);
    map.emplace(*SizeMap::build(size, domain, context));
    Box box;
    for (const Point p : domain.vertices) box.add(p);
    lattices = *LatticeMap::build(size, *map, box, shape, context);
  }

  std::size_t count(Kind kind) const {
    const auto& all = lattices.cells();
    return static_cast<std::size_t>(
        std::count_if(all.begin(), all.end(), [&](const auto& g) { return g.kind == kind; }));
  }
  Point random_point(std::mt19937_64& random) const {
    return {8 * static_cast<double>(random() >> 11) * 0x1p-53,
            8 * static_cast<double>(random() >> 11) * 0x1p-53};
  }

  const LatticeShape shape = LatticeShape::for_angle(20);
  ExecutionContext context;
  Expression size;
  Domain domain;
  std::optional<SizeMap> map;
  LatticeMap lattices;
};

TEST(LatticeMap, FollowsAHarmonicGradingWithFewCellsAndNoFault) {
  const LaidOut l("1e-4*exp(0.8*x)");
  EXPECT_LE(l.lattices.cells().size(), 64u);
  EXPECT_EQ(l.count(Kind::kFit), l.lattices.cells().size());
  // On either side of a border between cells the nearest point is the same.
  std::mt19937_64 random(1);
  int borders = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Point p = l.random_point(random);
    const auto& here = l.lattices.locate(p);
    const double h = std::sqrt(l.size(p) / kEquilateral);
    const auto& there = l.lattices.locate({p.x + h, p.y});
    if (&here == &there) continue;
    ++borders;
    const Point one = here.map.nearest(p, 0).at;
    const LatticePoint again = there.map.nearest(one, 0);
    if (again.spacing2 == 0) continue;  // beyond the disk
    EXPECT_LT(std::hypot(one.x - again.at.x, one.y - again.at.y), 0.1 * h) << p.x << " " << p.y;
  }
  EXPECT_GT(borders, 20);
}

TEST(LatticeMap, HasNoTriangleOverTheBoundInAFit) {
  for (const char* size :
       {"1e-3*exp(0.2*x)", "1e-3*(1+hypot(x-3,y-9))", "2e-3*(1.5+sin(x)*cos(y))", "1e-3*(1+x^2)"}) {
    const LaidOut l(size);
    EXPECT_GT(l.count(Kind::kFit), 0u) << size;
    std::mt19937_64 random(2);
    for (int i = 0; i < 20'000; ++i) {
      const Point p = l.random_point(random);
      const auto& cell = l.lattices.locate(p);
      if (cell.kind != Kind::kFit) continue;
      const double area = kEquilateral * cell.map.nearest(p, 0).spacing2;
      EXPECT_LE(area, 1.01 * l.size(p)) << size << " at " << p.x << " " << p.y;
      EXPECT_GE(area, 0.6 * l.size(p)) << size << " at " << p.x << " " << p.y;
    }
  }
}

TEST(LatticeMap, KnowsConstantPiecesAndTheStepBetweenThem) {
  const LaidOut l("x < 3 ? 1e-3 : 1e-2");
  EXPECT_EQ(l.lattices.locate({1, 1}).kind, Kind::kConstant);
  EXPECT_EQ(l.lattices.locate({1, 1}).size, 1e-3);
  EXPECT_EQ(l.lattices.locate({7, 7}).size, 1e-2);
  EXPECT_EQ(l.lattices.locate({3, 4}).kind, Kind::kStepped);
  EXPECT_EQ(l.count(Kind::kFit) + l.count(Kind::kMixed), 0u);
}

TEST(LatticeMap, HasNoLatticeWhereTheSizeWavesWithinAFewRows) {
  const LaidOut l("1e-2*(1.2+sin(40*x)*sin(40*y))");
  EXPECT_EQ(l.lattices.locate({4.1, 3.9}).kind, Kind::kMixed);
}

TEST(LatticeMap, FollowsAConeInSquaresOfAFewRows) {
  // Edges of 0.02 that grow by 0.2 per unit around a point. Near it their logarithm is harmonic
  // within a few rows only.
  const LaidOut l("sqrt(3)/4*(0.02+0.2*hypot(x-4,y-4))^2");
  std::mt19937_64 random(5);
  constexpr int kPoints = 10'000;
  int on_lattice = 0;
  for (int i = 0; i < kPoints; ++i) {
    const Point p = l.random_point(random);
    on_lattice +=
        l.lattices.locate({3.8 + 0.05 * p.x, 3.8 + 0.05 * p.y}).kind == Kind::kFit ? 1 : 0;
  }
  EXPECT_GT(on_lattice, 0.9 * kPoints);
}

TEST(LatticeMap, LeavesOutWhatIsOutsideOfTheDomain) {
  Pslg ring = square(8);
  add_box(ring, {1, 1}, {7, 7});
  ring.holes.push_back({4, 4});
  const LaidOut l("1e-5+1e-3*((x-4)^2+(y-4)^2)", ring);
  EXPECT_EQ(l.lattices.locate({4.1, 4.1}).kind, Kind::kOutside);
  EXPECT_LT(l.lattices.cells().size(), 2000u);
}

TEST(LatticeMap, OfHostileSizesIsFiniteAndSmall) {
  for (const char* size :
       {"0/0", "x < 4 ? 0/0 : 1e-3", "1/0", "-1", "0", "1e-300", "1e-320", "1e300", "1e-12*(1+x)",
        "1e-9+abs(sin(1e9*x*y))", "hypot(x-3,y-3) < 1e-6 ? 1e-16 : 1", "exp(100*x)",
        "exp(-700*x/8)", "1e-3*(1+floor(1e6*x))", "x*y", "1/(x-4)"}) {
    const LaidOut l(size);
    EXPECT_LE(l.lattices.cells().size(), LatticeMap::kMaxCells) << size;
    std::mt19937_64 random(3);
    for (int i = 0; i < 2000; ++i) {
      const Point p = l.random_point(random);
      const auto& cell = l.lattices.locate(p);
      if (cell.kind != Kind::kFit) continue;
      const LatticePoint nearest = cell.map.nearest(p, l.shape.jitter);
      EXPECT_TRUE(std::isfinite(nearest.at.x) && std::isfinite(nearest.at.y)) << size;
    }
  }
}

TEST(LatticeMap, IsTheSameAtEveryNumberOfThreads) {
  const char* const kSize = "1e-4*(1.5+sin(2*x)*cos(3*y))";
  const LaidOut one(kSize);
  EXPECT_GT(one.lattices.cells().size(), 100u);
  for (const int threads : {2, 3, 7}) {
    Arena arena(threads);
    const LaidOut many(kSize, square(8), &arena);
    ASSERT_EQ(one.lattices.cells().size(), many.lattices.cells().size());
    std::mt19937_64 random(4);
    for (int i = 0; i < 10'000; ++i) {
      const Point p = one.random_point(random);
      const auto& a = one.lattices.locate(p);
      const auto& b = many.lattices.locate(p);
      ASSERT_EQ(a.kind, b.kind);
      if (a.kind != Kind::kFit) continue;
      const LatticePoint x = a.map.nearest(p, 1e-4);
      const LatticePoint y = b.map.nearest(p, 1e-4);
      ASSERT_EQ(x.at.x, y.at.x);
      ASSERT_EQ(x.at.y, y.at.y);
    }
  }
}

TEST(LatticeMap, StopsWhenTheJobIsCancelled) {
  const LaidOut l("1e-6*(1.5+sin(9*x)*cos(9*y))");
  ExecutionContext cancelled;
  cancelled.cancel();
  const auto stopped = LatticeMap::build(l.size, *l.map, {0, 0, 8, 8}, l.shape, cancelled);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace weft
