// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/ring_crossing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "files/formats/derived/orientation.h"

namespace weft::files {
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

using Rings = std::vector<std::vector<Point>>;

std::optional<RingOverlap> overlap_of(const Rings& rings,
                                      RingRoles roles = RingRoles::kOuterFirst) {
  const std::vector<std::span<const Point>> spans(rings.begin(), rings.end());
  return find_overlap(spans, roles);
}

std::vector<Point> box(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

TEST(RingOverlap, NamesTheHoleThatIsOutsideOrInAnotherHole) {
  const std::vector<Point> outer = box(0, 0, 10, 10);
  for (const std::vector<Point>& second :
       {box(12, 0, 13, 1), box(10, 2, 11, 3), box(1, 1, 2, 2), box(0, 0, 3, 3)}) {
    const auto found = overlap_of({outer, box(0, 0, 3, 3), second});
    ASSERT_TRUE(found);
    EXPECT_FALSE(found->crossed);
    EXPECT_EQ(found->ring, 2U);
  }
  EXPECT_EQ(overlap_of({outer, box(12, 0, 13, 1)})->at, (Point{12, 0}));
  EXPECT_TRUE(overlap_of({outer, outer}) == std::nullopt);  // all of it is a hole
}

TEST(RingOverlap, NamesRingsThatCrossWhateverTheyAre) {
  for (const RingRoles roles : {RingRoles::kOuterFirst, RingRoles::kByPlace}) {
    const auto found = overlap_of({box(0, 0, 9, 9), box(1, 1, 3, 3), box(2, 2, 4, 4)}, roles);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->ring, 2U);
    EXPECT_EQ(found->crossed, 1U);
  }
}

TEST(RingOverlap, NamesTheRingWhoseDirectionIsWrongForItsPlace) {
  const auto reversed = [](std::vector<Point> ring) {
    std::reverse(ring.begin(), ring.end());
    return ring;
  };
  const std::vector<Point> hole = reversed(box(1, 1, 5, 5));
  for (const bool turned : {false, true}) {
    const auto found = [&](Rings rings) {
      if (turned)
        for (std::vector<Point>& ring : rings) ring = reversed(ring);
      return overlap_of(rings, RingRoles::kByDirection);
    };
    EXPECT_FALSE(found({hole, box(2, 2, 3, 3), box(0, 0, 9, 9), box(20, 0, 21, 1)}));
    EXPECT_EQ(found({box(0, 0, 9, 9), box(1, 1, 5, 5)})->ring, 1U);
    EXPECT_EQ(found({box(0, 0, 9, 9), hole, reversed(box(20, 0, 21, 1))})->ring, 2U);
  }
}

TEST(RingOverlap, LetsHolesTouchAndRingsBeInAnyOrderWithoutHoles) {
  EXPECT_FALSE(overlap_of({box(0, 0, 9, 9), box(1, 1, 2, 2), box(2, 1, 3, 2), box(1, 2, 2, 3)}));
  EXPECT_FALSE(overlap_of({box(0, 0, 9, 9), box(1, 2, 2, 3), box(1, 1, 2, 2)}));
  EXPECT_FALSE(overlap_of({box(0, 0, 9, 9), box(0, 1, 1, 2), box(3, 0, 4, 9), box(8, 8, 9, 9)}));
  EXPECT_FALSE(
      overlap_of({box(0, 0, 1, 1), box(5, 5, 6, 6), box(5, 5, 9, 9)}, RingRoles::kByPlace));
}

// Lattice polygons without crossings have faces of area 1/2 or more, so that a fine grid finds
// each.
TEST(RingOverlap, AgreesWithWindingNumbersOnRandomRings) {
  std::mt19937 random(20240611);
  std::uniform_int_distribution<int> lattice(0, 4);
  int checked = 0;
  int overlapping = 0;
  for (int round = 0; round < 4000; ++round) {
    Rings rings(3);
    if (round % 2 == 0) rings[0] = box(0, 0, 4, 4);
    for (std::vector<Point>& ring : rings)
      while (ring.size() < static_cast<std::size_t>(3 + round % 3)) {
        const Point p{double(lattice(random)), double(lattice(random))};
        if (std::find(ring.begin(), ring.end(), p) == ring.end()) ring.push_back(p);
      }
    const auto area = [](const std::vector<Point>& ring) {
      double sum = 0;
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Point& q = ring[(i + 1) % ring.size()];
        sum += ring[i].x * q.y - q.x * ring[i].y;
      }
      return sum;
    };
    if (std::any_of(rings.begin(), rings.end(), [&](const std::vector<Point>& ring) {
          return crosses(ring) || area(ring) == 0;
        }))
      continue;
    const auto found = overlap_of(rings);
    if (found && found->crossed) continue;
    for (std::size_t r = 0; r < rings.size(); ++r)
      if ((area(rings[r]) > 0) != (r == 0)) std::reverse(rings[r].begin(), rings[r].end());
    bool expected = false;
    for (int i = 0; i < 80; ++i)
      for (int j = 0; j < 80; ++j) {
        const Point p{0.0503 * i + 0.0021, 0.0501 * j + 0.0037};
        int winding = 0;
        for (const std::vector<Point>& ring : rings)
          for (std::size_t k = 0; k < ring.size(); ++k) {
            const Point a = ring[k];
            const Point b = ring[(k + 1) % ring.size()];
            if (a.y <= p.y && b.y > p.y && orientation(a, b, p) > 0) ++winding;
            if (b.y <= p.y && a.y > p.y && orientation(a, b, p) < 0) --winding;
          }
        expected = expected || (winding != 0 && winding != 1);
      }
    ++checked;
    overlapping += expected;
    EXPECT_EQ(found.has_value(), expected) << round;
  }
  EXPECT_GT(overlapping, 100);
  EXPECT_GT(checked - overlapping, 20);
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
}  // namespace weft::files
