// SPDX-License-Identifier: Apache-2.0
#include "engine/size/size_map.h"

#include <gtest/gtest.h>

#include <random>

#include "engine/size/expression/expression.h"
#include "tests/engine/domain/shapes.h"

namespace weft {
namespace {

struct Mapped {
  Mapped(const char* text, const Pslg& pslg)
      : size(*Expression::parse(text)),
        domain(*triangulate(pslg, context)),
        map(*SizeMap::build(size, domain, context)) {}

  ExecutionContext context;
  Expression size;
  Domain domain;
  SizeMap map;
};

Box around(Point p, double reach) {
  return {p.x - reach, p.y - reach, p.x + reach, p.y + reach};
}

TEST(SizeMap, BoundsTheFunctionInEveryBox) {
  const Mapped m("abs(x-3) < 1 ? 0.01 + 0.001*sin(9*y) : 0.1*exp(0.1*x)", square(8));
  std::mt19937_64 random(1);
  for (int i = 0; i < 20'000; ++i) {
    const Point p{8 * (random() >> 11) * 0x1p-53, 8 * (random() >> 11) * 0x1p-53};
    const auto place = m.map.locate(around(p, 0.01));
    EXPECT_LE(place.node->lo, m.size(p));
    EXPECT_GE(place.node->hi, m.size(p));
  }
}

TEST(SizeMap, OfAStepFunctionIsConstantAwayFromTheStep) {
  const Mapped m("x < 3 ? 0.01 : 1", square(8));
  EXPECT_TRUE(m.map.locate(around({1, 1}, 0.1)).node->constant());
  EXPECT_TRUE(m.map.locate(around({7, 1}, 0.1)).node->constant());
  EXPECT_FALSE(m.map.locate(around({3, 1}, 0.1)).node->constant());
}

TEST(SizeMap, EstimatesTheTrianglesFromBelow) {
  const Mapped m("x < 4 ? 0.01 : 1", square(8));
  // The boxes that touch the step count at the larger size.
  EXPECT_GT(m.map.triangles_lower_bound(), 0.9 * (32 / 0.01 + 32));
  EXPECT_LE(m.map.triangles_lower_bound(), 1.0000001 * (32 / 0.01 + 32));
}

TEST(SizeMap, LooksAtNoBoxOutsideTheDomain) {
  Pslg ring = square(8);
  add_box(ring, {3, 3}, {5, 5});
  ring.holes.push_back({4, 4});
  const Mapped m("(x-4)^2+(y-4)^2", ring);
  EXPECT_LT(m.map.bytes(), 200'000u);
}

TEST(SizeMap, FindsAFinerBoxUnderATriangle) {
  const Mapped m("(x-6)^2+(y-2)^2 < 0.01 ? 1e-4 : 100", square(8));
  const std::array<Point, 3> covers{{{4, 1}, {8, 1}, {6, 5}}};
  const std::array<Point, 3> misses{{{0, 4}, {4, 8}, {0, 8}}};
  EXPECT_TRUE(m.map.covers_finer(m.map.locate({4, 1, 8, 5}), covers, 8));
  EXPECT_FALSE(m.map.covers_finer(m.map.locate({0, 4, 4, 8}), misses, 8));
}

}  // namespace
}  // namespace weft
