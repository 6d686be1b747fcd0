// SPDX-License-Identifier: Apache-2.0
#include "engine/size/domain_cover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/size/box_overlap.h"
#include "tests/engine/domain/shapes.h"
#include "tests/support/generator.h"

namespace weft {
namespace {

Domain domain_of(const Pslg& pslg) {
  const ExecutionContext context;
  return triangulate(pslg, context).value();
}

bool is_met(const Domain& domain, const Box& box) {
  for (std::uint32_t t = 0; t < domain.triangles.size(); ++t)
    if (overlap(box, corners_of(domain, t))) return true;
  return false;
}

// A star with a hole in the middle, turned and squeezed; every third one is small and far from the
// origin, as in metres of a map.
Pslg star(Generator& random, int round) {
  const double squeeze = round % 2 == 0 ? 1 : 0.01;
  const Point middle = round % 3 == 0 ? Point{450'000, 5'500'000} : Point{0, 0};
  const double angle = random.between(0, 6);
  const auto ring = [&](int corners, double low, double high) {
    std::vector<Point> points;
    for (int i = 0; i < corners; ++i) {
      const double r = random.between(low, high), t = 6.283185307179586 * i / corners;
      const double x = r * std::cos(t), y = squeeze * r * std::sin(t);
      points.push_back({middle.x + x * std::cos(angle) - y * std::sin(angle),
                        middle.y + x * std::sin(angle) + y * std::cos(angle)});
    }
    return points;
  };
  Pslg pslg;
  add_ring(pslg, ring(40, 3, 10));
  add_ring(pslg, ring(12, 0.5, 2));
  pslg.holes.push_back(middle);
  return pslg;
}

TEST(DomainCover, MeetsEveryBoxThatTheDomainMeets) {
  Generator random(1);
  for (int round = 0; round < 40; ++round) {
    const Domain domain = domain_of(star(random, round));
    const DomainCover cover = DomainCover::make(domain, {}).value();
    const Box around = cover.box();
    int met = 0;
    for (int i = 0; i < 400; ++i) {
      const double side = std::pow(10, random.between(-4, 1));
      const double x = random.between(around.min_x - side, around.max_x);
      const double y = random.between(around.min_y - side, around.max_y);
      const Box box{x, y, x + side, y + side};
      if (!is_met(domain, box)) continue;
      ++met;
      EXPECT_TRUE(cover.meets(box)) << round << ": " << x << " " << y << " " << side;
    }
    EXPECT_GT(met, 20) << round;
  }
}

TEST(DomainCover, MeetsNoBoxThatIsFurtherAwayThanTwoCells) {
  Generator random(2);
  for (int round = 0; round < 40; ++round) {
    const Domain domain = domain_of(star(random, round));
    const DomainCover cover = DomainCover::make(domain, {}).value();
    const Box around = cover.box();
    const auto cells = static_cast<double>(64 + 8 * domain.vertices.size());
    const double cell = std::max(std::sqrt(around.width() * around.height() / cells),
                                 std::max(around.width(), around.height()) / cells);
    int missed = 0;
    for (int i = 0; i < 400; ++i) {
      const double x = random.between(around.min_x, around.max_x);
      const double y = random.between(around.min_y, around.max_y);
      const double far = 2 * cell;
      if (is_met(domain, {x - far, y - far, x + far, y + far})) continue;
      ++missed;
      EXPECT_FALSE(cover.meets({x, y, x, y})) << round << ": " << x << " " << y;
    }
    if (round % 2 == 0) EXPECT_GT(missed, 10) << round;
  }
}

TEST(DomainCover, OfABoxIsTheBox) {
  const DomainCover cover = Box{0, 0, 2, 1};
  EXPECT_TRUE(cover.meets({1.5, 0.5, 3, 3}));
  EXPECT_FALSE(cover.meets({2.5, 0.5, 3, 3}));
  EXPECT_FALSE(DomainCover::nothing_of({0, 0, 2, 1}).meets({0, 0, 1, 1}));
}

TEST(DomainCover, IsCancelled) {
  ExecutionContext context;
  context.cancel();
  Generator random(3);
  std::vector<Point> ring;
  for (int i = 0; i < 20'000; ++i)
    ring.push_back(
        {std::cos(i * 6.283185307179586 / 20'000), std::sin(i * 6.283185307179586 / 20'000)});
  Pslg pslg;
  add_ring(pslg, ring);
  const auto cover = DomainCover::make(domain_of(pslg), context);
  ASSERT_FALSE(cover);
  EXPECT_EQ(cover.error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace weft
