// SPDX-License-Identifier: Apache-2.0
#include "client/formats/domains/ring_crossing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "client/formats/derived/orientation.h"

namespace weft::client {
namespace {

// The definition, on all pairs.
bool crosses(const std::vector<Point>& ring) {
  const auto end = [&ring](std::size_t i) { return ring[(i + 1) % ring.size()]; };
  for (std::size_t i = 0; i < ring.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (orientation(ring[i], end(i), ring[j]) * orientation(ring[i], end(i), end(j)) < 0 &&
          orientation(ring[j], end(j), ring[i]) * orientation(ring[j], end(j), end(i)) < 0)
        return true;
  return false;
}

TEST(RingOrientation, IsExactWhereDoublesCancel) {
  const double tiny = std::ldexp(1, -52);
  EXPECT_EQ(orientation({0.5, 0.5}, {12, 12}, {24, 24}), 0);
  EXPECT_EQ(orientation({0.5, 0.5 + tiny / 2}, {12, 12}, {24, 24}), 1);
  EXPECT_EQ(orientation({0.5 + tiny / 2, 0.5}, {12, 12}, {24, 24}), -1);
  EXPECT_EQ(orientation({0, 0}, {1, 0}, {0, 1}), 1);
  EXPECT_EQ(orientation({0.1, 0.1}, {0.2, 0.2}, {0.3, 0.3}),
            -orientation({0.2, 0.2}, {0.1, 0.1}, {0.3, 0.3}));
}

TEST(RingCrossing, FindsABowTie) {
  const std::vector<Point> ring = {{0, 0}, {4, 4}, {4, 0}, {0, 4}};
  EXPECT_EQ(find_crossing(ring), (std::pair<std::uint32_t, std::uint32_t>{0, 2}));
}

TEST(RingCrossing, LetsTouchingThrough) {
  EXPECT_FALSE(find_crossing(std::vector<Point>{{0, 0}, {4, 0}, {2, 2}, {4, 4}, {0, 4}, {2, 2}}));
  EXPECT_FALSE(find_crossing(std::vector<Point>{{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}}));
}

TEST(RingCrossing, LetsASpikeThrough) {
  EXPECT_FALSE(find_crossing(std::vector<Point>{{0, 0}, {4, 0}, {8, 0}, {4, 0}, {4, 4}}));
}

TEST(RingCrossing, AgreesWithAllPairsOnRandomRings) {
  std::mt19937 random(20240607);
  int crossing = 0;
  for (int round = 0; round < 20000; ++round) {
    // Few lattice points, so that touching, overlap and vertical edges abound.
    std::uniform_int_distribution<int> size(3, 8);
    std::uniform_int_distribution<int> lattice(0, round % 2 == 0 ? 4 : 1000);
    std::vector<Point> ring;
    const int n = size(random);
    while (static_cast<int>(ring.size()) < n) {
      const Point p{double(lattice(random)), double(lattice(random))};
      if (ring.empty() || (p != ring.back() && (int(ring.size()) + 1 < n || p != ring.front())))
        ring.push_back(p);
    }
    const bool expected = crosses(ring);
    crossing += expected;
    EXPECT_EQ(find_crossing(ring).has_value(), expected) << round;
  }
  EXPECT_GT(crossing, 1000);
  EXPECT_LT(crossing, 19000);
}

TEST(RingCrossing, IsFastOnLongParallelEdges) {
  // A comb of 200,000 diagonal teeth whose boxes all overlap.
  std::vector<Point> ring;
  constexpr int kTeeth = 100'000;
  for (int i = 0; i < kTeeth; ++i) {
    ring.push_back({double(i), 0.0});
    ring.push_back({double(i) + kTeeth, double(kTeeth)});
  }
  ring.push_back({3.0 * kTeeth, -1.0});
  ring.push_back({-1.0, -1.0});
  EXPECT_FALSE(find_crossing(ring));
}

}  // namespace
}  // namespace weft::client
