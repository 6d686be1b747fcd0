// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/simplify/simplify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "tests/engine/domain/laws.h"
#include "tests/engine/domain/shapes.h"

namespace weft {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

Domain domain_of(const Pslg& pslg) {
  const ExecutionContext context;
  auto domain = triangulate(pslg, context);
  EXPECT_TRUE(domain) << domain.error().message;
  return domain ? *std::move(domain) : Domain{};
}

// Features are made no finer than `length`.
Result<Simplified> simplify_to(const Domain& domain, double length) {
  const ExecutionContext context;
  return simplify(domain,
                  {.share = 0.5,
                   .edge = [=](Point) { return 2 * length; },
                   .region_edge = std::vector<double>(domain.regions.size(), kUnbounded)},
                  context);
}

struct Made {
  Domain domain;
  Simplification changes;
};

Made simplified(const Pslg& pslg, double length) {
  auto made = simplify_to(domain_of(pslg), length);
  EXPECT_TRUE(made) << made.error().message;
  if (!made) return {};
  EXPECT_EQ(broken_law(pslg, made->domain), std::nullopt);
  return {std::move(made->domain), made->changes};
}

double shortest_line(const Domain& domain) {
  double shortest = kUnbounded;
  for (const Subsegment& s : domain.subsegments)
    shortest = std::min(shortest, std::sqrt(distance2(domain.vertices[s.a], domain.vertices[s.b])));
  return shortest;
}

bool has_vertex(const Domain& domain, Point p) {
  return std::find(domain.vertices.begin(), domain.vertices.end(), p) != domain.vertices.end();
}

// A basin of 20 by 20 with an opening in its upper side, which `outline` leads through.
Pslg basin(const std::vector<Point>& outline) {
  Pslg pslg;
  std::vector<Point> ring{{0, 0}, {20, 0}, {20, 20}};
  ring.insert(ring.end(), outline.begin(), outline.end());
  ring.push_back({0, 20});
  add_ring(pslg, ring, 1);
  return pslg;
}

TEST(Simplify, ClosesAnInletThatIsNarrower) {
  const Made made = simplified(basin({{10.35, 20}, {10.35, 30}, {9.65, 30}, {9.65, 20}}), 1);
  EXPECT_EQ(cover(made.domain, {10, 25}), 0);
  EXPECT_NEAR(made.changes.area, -7, 0.5);
  EXPECT_LE(made.changes.farthest, 1);
  EXPECT_GE(shortest_line(made.domain), 1);
}

TEST(Simplify, KeepsAnInletThatIsWider) {
  const Made made = simplified(basin({{11.3, 20}, {11.3, 30}, {8.7, 30}, {8.7, 20}}), 1);
  EXPECT_EQ(cover(made.domain, {10.1, 25.2}), 1);
  EXPECT_EQ(made.changes.points, 0u);
  EXPECT_EQ(made.changes.area, 0);
}

TEST(Simplify, OpensASpitThatIsNarrower) {
  const Made made = simplified(basin({{10.4, 20}, {10.4, 10}, {9.6, 10}, {9.6, 20}}), 1);
  EXPECT_EQ(cover(made.domain, {10, 15.1}), 1);
  EXPECT_NEAR(made.changes.area, 8, 0.5);
}

TEST(Simplify, CutsASpike) {
  const Made made = simplified(basin({{12, 20}, {10, 30}, {8, 20}}), 1);
  EXPECT_EQ(cover(made.domain, {10, 28.5}), 0);
  EXPECT_EQ(cover(made.domain, {10, 22.1}), 1);
}

TEST(Simplify, DropsAnIslandThatIsSmallerAndKeepsALargerOne) {
  Pslg pslg;
  add_box(pslg, {0, 0}, {20, 20});
  add_box(pslg, {5, 5}, {5.6, 5.6});
  add_box(pslg, {12, 12}, {14, 14});
  pslg.holes = {{5.1, 5.2}, {13.1, 13.2}};
  const Made made = simplified(pslg, 1);
  EXPECT_EQ(made.changes.islands, 1u);
  EXPECT_EQ(made.changes.points, 4u);
  EXPECT_NEAR(made.changes.area, 0.36, 1e-9);
  EXPECT_EQ(cover(made.domain, {5.15, 5.25}), 1);
  EXPECT_EQ(cover(made.domain, {13.1, 13.3}), 0);
}

TEST(Simplify, DropsALongIslandThatIsNarrower) {
  Pslg pslg;
  add_box(pslg, {0, 0}, {20, 20});
  add_box(pslg, {4, 9.8}, {16, 10.2});
  pslg.holes = {{5, 10}};
  const Made made = simplified(pslg, 1);
  EXPECT_EQ(made.changes.islands, 1u);
  EXPECT_NEAR(area(made.domain), 400, 1e-9);
}

TEST(Simplify, DropsAWaterThatIsSmaller) {
  Pslg pslg;
  add_box(pslg, {0, 0}, {20, 20});
  add_box(pslg, {30, 0}, {30.5, 0.5});
  const Made made = simplified(pslg, 1);
  EXPECT_EQ(made.changes.waters, 1u);
  EXPECT_NEAR(area(made.domain), 400, 1e-9);
}

// Triangles that are connected across edges.
int parts(const Domain& domain) {
  int count = 0;
  std::vector<bool> seen(domain.triangles.size(), false);
  std::vector<std::uint32_t> stack;
  for (std::uint32_t first = 0; first < seen.size(); ++first) {
    if (seen[first]) continue;
    ++count;
    seen[first] = true;
    stack.push_back(first);
    while (!stack.empty()) {
      const std::uint32_t t = stack.back();
      stack.pop_back();
      for (const std::uint32_t n : domain.triangles[t].neighbor) {
        if (n == kNone || seen[n]) continue;
        seen[n] = true;
        stack.push_back(n);
      }
    }
  }
  return count;
}

// Vertices that the border passes more than once.
int pinches(const Domain& domain) {
  std::vector<int> borders(domain.vertices.size(), 0);
  for (const Domain::Triangle& t : domain.triangles)
    for (int i = 0; i < 3; ++i)
      if (t.neighbor[i] == kNone) ++borders[t.vertex[(i + 1) % 3]];
  return static_cast<int>(
      std::count_if(borders.begin(), borders.end(), [](int count) { return count > 1; }));
}

// A basin of 10 by 10 and one of `second` by 10, with a channel of this width and a length of 5
// between them.
Pslg two_basins(double width, double second = 10) {
  const double low = 5 - width / 2, high = 5 + width / 2;
  Pslg pslg;
  add_ring(pslg, {{0, 0},
                  {10, 0},
                  {10, low},
                  {15, low},
                  {15, 0},
                  {15 + second, 0},
                  {15 + second, 10},
                  {15, 10},
                  {15, high},
                  {10, high},
                  {10, 10},
                  {0, 10}});
  return pslg;
}

TEST(Simplify, CutsAChannelThatIsNarrowerAndDropsTheSmallWaterBehindIt) {
  const Made made = simplified(two_basins(0.7, 3), 1);
  EXPECT_EQ(made.changes.channels, 1u);
  ASSERT_EQ(made.changes.cuts.size(), 1u);
  const Point cut = made.changes.cuts[0];
  EXPECT_TRUE(10 <= cut.x && cut.x <= 15 && 4.6 <= cut.y && cut.y <= 5.4) << cut.x << ' ' << cut.y;
  EXPECT_EQ(made.changes.cut_off, 1u);
  EXPECT_EQ(made.changes.waters, 0u);
  EXPECT_EQ(made.changes.straits, 0u);
  EXPECT_NEAR(area(made.domain), 100, 0.5);
  EXPECT_EQ(cover(made.domain, {5.1, 5.2}), 1);
}

TEST(Simplify, DropsTheSmallWaterWhicheverComesFirst) {
  for (const double x : {1, -1}) {
    for (const double y : {1, -1}) {
      Pslg pslg = two_basins(0.7, 3);
      for (Point& p : pslg.points) p = {x * p.x, y * p.y};
      const Made made = simplified(pslg, 1);
      EXPECT_EQ(made.changes.cut_off, 1u);
      EXPECT_EQ(made.changes.straits, 0u);
      EXPECT_NEAR(area(made.domain), 100, 0.5);
    }
  }
}

// A basin of 80 by 10 and a moat that is narrower, from its one end to the other.
TEST(Simplify, ClosesAMoatHoweverLong) {
  Pslg pslg;
  add_box(pslg, {0, 0}, {80, 40});
  add_box(pslg, {0.7, 0.7}, {79.3, 30});
  pslg.holes = {{20, 15}};
  const Made made = simplified(pslg, 1);
  EXPECT_EQ(made.changes.straits, 0u);
  EXPECT_NEAR(area(made.domain), 800, 45);  // its own shores move by up to half of the length, too
}

TEST(Simplify, CutsAChannelThatIsHardlyNarrower) {
  EXPECT_EQ(simplified(two_basins(0.98, 3), 1).changes.cut_off, 1u);
  EXPECT_EQ(simplified(two_basins(1.1, 3), 1).changes.channels, 0u);
}

TEST(Simplify, KeepsAStraitToALargeWater) {
  const Made made = simplified(two_basins(0.7), 1);
  EXPECT_EQ(made.changes.channels, 0u);
  EXPECT_EQ(made.changes.cut_off, 0u);
  EXPECT_EQ(made.changes.straits, 1u);
  EXPECT_EQ(cover(made.domain, {12.5, 5.01}), 1);
  EXPECT_EQ(parts(made.domain), 1);
}

TEST(Simplify, KeepsTheWayToAPointInASmallWater) {
  Pslg pslg = two_basins(0.7, 3);
  pslg.points.push_back({16.6, 5.3});
  const Made made = simplified(pslg, 1);
  EXPECT_EQ(made.changes.straits, 1u);
  EXPECT_TRUE(has_vertex(made.domain, {16.6, 5.3}));
  EXPECT_EQ(parts(made.domain), 1);
}

TEST(Simplify, DropsNoWaterForAPointInAnInlet) {
  Pslg pslg;
  add_ring(pslg,
           {{0, 0}, {5, 0}, {5, 2}, {7, 2}, {9, 2}, {9, 2.6}, {7, 2.6}, {5, 2.6}, {5, 5}, {0, 5}});
  pslg.points.push_back({8.8, 2.3});
  const Made made = simplified(pslg, 1);
  EXPECT_EQ(made.changes.straits, 1u);
  EXPECT_TRUE(has_vertex(made.domain, {8.8, 2.3}));
  EXPECT_EQ(cover(made.domain, {2.13, 1.37}), 1);
  EXPECT_EQ(parts(made.domain), 1);
}

// A large basin and one more, with a channel of 0.5 and one of 0.7 between them.
TEST(Simplify, KeepsTheWidestOfTwoWays) {
  Pslg pslg;
  add_box(pslg, {0, 0}, {25, 10});
  add_ring(pslg, {{10, 0.5}, {15, 0.5}, {15, 9.3}, {10, 9.3}});
  pslg.holes = {{12, 5.1}};
  const Made made = simplified(pslg, 1);
  EXPECT_EQ(made.changes.channels, 1u);
  EXPECT_EQ(made.changes.straits, 1u);
  EXPECT_EQ(made.changes.cut_off, 0u);
  EXPECT_EQ(cover(made.domain, {12.51, 0.26}), 0);
  EXPECT_EQ(cover(made.domain, {12.51, 9.66}), 1);
  EXPECT_EQ(parts(made.domain), 1);
}

TEST(Simplify, KeepsWatersThatWereApart) {
  Pslg pslg;
  add_box(pslg, {0, 0}, {20, 20});
  add_box(pslg, {30, 0}, {34, 4});
  const Made made = simplified(pslg, 1);
  EXPECT_EQ(parts(made.domain), 2);
  EXPECT_EQ(made.changes.cut_off, 0u);
}

// The channel between an island's corner and the shore is cut there, which leaves water on both
// sides of the corner.
TEST(Simplify, LeavesNoPinch) {
  Pslg pslg;
  add_box(pslg, {0, 0}, {20, 20});
  add_ring(pslg, {{10, 19.5}, {5, 10}, {15, 10}});
  pslg.holes = {{10, 11}};
  const Made made = simplified(pslg, 1);
  EXPECT_EQ(made.changes.channels, 1u);
  EXPECT_EQ(pinches(made.domain), 0);
  EXPECT_LE(made.changes.farthest, 1);
}

TEST(Simplify, LeavesAPinchOfTheInput) {
  Pslg pslg;
  add_box(pslg, {0, 0}, {40, 20});
  add_ring(pslg, {{10, 15}, {5, 10}, {10, 5}});
  add_ring(pslg, {{10, 15}, {10, 18}, {16, 17}});
  add_ring(pslg, {{30, 19.5}, {25, 10}, {35, 10}});  // a cut channel beside it
  pslg.holes = {{9, 10}, {12, 17}, {30, 11}};
  const Made made = simplified(pslg, 1);
  EXPECT_EQ(made.changes.channels, 1u);
  EXPECT_EQ(pinches(made.domain), 1);
  EXPECT_TRUE(has_vertex(made.domain, {10, 15}));
}

TEST(Simplify, KeepsAChannelThatIsWider) {
  const Made made = simplified(two_basins(2.5), 1);
  EXPECT_EQ(made.changes.channels, 0u);
  EXPECT_EQ(cover(made.domain, {12.5, 5.01}), 1);
}

// A shore along y = 10 with teeth of 0.3.
Pslg toothed_shore(int teeth) {
  Pslg pslg;
  std::vector<Point> ring{{0, 0}, {20, 0}, {20, 10}};
  for (int i = 1; i < 2 * teeth; ++i)
    ring.push_back({20 - 20.0 * i / (2 * teeth), i % 2 == 0 ? 10 : 10.3});
  ring.push_back({0, 10});
  add_ring(pslg, ring, 3);
  return pslg;
}

TEST(Simplify, MakesNoLineShorterAndStaysNear) {
  const Made made = simplified(toothed_shore(200), 1);
  EXPECT_GE(shortest_line(made.domain), 1);
  EXPECT_GT(made.changes.points, 300u);
  EXPECT_LE(made.changes.farthest, 1);
  EXPECT_GT(made.changes.farthest, 0);
  for (const Subsegment& s : made.domain.subsegments) EXPECT_EQ(s.marker, 3);
}

TEST(Simplify, ChangesNothingThatIsCoarser) {
  const Pslg pslg = toothed_shore(3);
  const Domain before = domain_of(pslg);
  const auto made = simplify_to(before, 1);
  ASSERT_TRUE(made);
  EXPECT_EQ(made->changes.points, 0u);
  EXPECT_EQ(made->changes.farthest, 0);
  EXPECT_EQ(made->domain.vertices, before.vertices);
}

TEST(Simplify, LeavesWhatHasNoBound) {
  const Pslg pslg = toothed_shore(200);
  const Domain before = domain_of(pslg);
  const auto made = simplify_to(before, kUnbounded);
  ASSERT_TRUE(made);
  EXPECT_EQ(made->domain.vertices, before.vertices);
}

TEST(Simplify, TakesTheBoundsOfRegionsAndMarkers) {
  const Domain before = domain_of(toothed_shore(200));
  const ExecutionContext context;
  Finest finest{.share = 1, .edge = [](Point) { return kUnbounded; }, .region_edge = {1}};
  const auto by_region = simplify(before, finest, context);
  finest.region_edge = {kUnbounded};
  finest.marker_edge = {{3, 1}};
  const auto by_marker = simplify(before, finest, context);
  finest.marker_edge = {{4, 1}};
  const auto by_other = simplify(before, finest, context);
  ASSERT_TRUE(by_region && by_marker && by_other);
  EXPECT_GE(shortest_line(by_region->domain), 1);
  EXPECT_EQ(by_region->domain.vertices, by_marker->domain.vertices);
  EXPECT_EQ(by_other->changes.points, 0u);
}

TEST(Simplify, KeepsTheEndsOfMarkers) {
  Pslg pslg = toothed_shore(200);
  pslg.segments[0].marker = 7;  // along y = 0
  pslg.segments[100].marker = 9;
  const Point a = pslg.points[pslg.segments[100].a], b = pslg.points[pslg.segments[100].b];
  const Made made = simplified(pslg, 1);
  EXPECT_TRUE(has_vertex(made.domain, a));
  EXPECT_TRUE(has_vertex(made.domain, b));
  std::multiset<std::int32_t> markers;
  for (const Subsegment& s : made.domain.subsegments) markers.insert(s.marker);
  EXPECT_EQ(markers.count(7), 1u);
  EXPECT_EQ(markers.count(9), 1u);
}

TEST(Simplify, KeepsJunctionsLooseLinesAndPoints) {
  Pslg pslg = toothed_shore(200);
  const Point shore = pslg.points[100];
  add_segment(pslg, shore, {shore.x, 4}, 5);
  pslg.points.push_back({2.5, 9.9});
  const Made made = simplified(pslg, 1);
  EXPECT_TRUE(has_vertex(made.domain, shore));
  EXPECT_TRUE(has_vertex(made.domain, {shore.x, 4}));
  EXPECT_TRUE(has_vertex(made.domain, {2.5, 9.9}));
}

TEST(Simplify, MovesTheBorderOfTwoRegionsForBoth) {
  Pslg pslg;
  add_box(pslg, {0, 0}, {20, 20}, 1);
  std::vector<Point> border{{10, 0}};
  for (int i = 1; i < 100; ++i) border.push_back({i % 2 == 0 ? 10 : 10.1, 0.2 * i});
  border.push_back({10, 20});
  for (std::size_t i = 1; i < border.size(); ++i) add_segment(pslg, border[i - 1], border[i], 2);
  pslg.regions = {{{5, 5}, 1, {}}, {{15, 5}, 2, {}}};
  const Made made = simplified(pslg, 1);
  EXPECT_GE(shortest_line(made.domain), 1);
  EXPECT_NEAR(area(made.domain), 400, 1e-9);
  EXPECT_NEAR(made.changes.area, 0, 1e-9);
  for (const Domain::Triangle& t : made.domain.triangles) {
    double x = 0;
    for (const std::uint32_t v : t.vertex) x += made.domain.vertices[v].x / 3;
    EXPECT_EQ(made.domain.regions[t.region].id, x < 10 ? 1 : 2);
  }
}

TEST(Simplify, NamesItselfIfNothingIsLeft) {
  Pslg pslg;
  add_box(pslg, {0, 0}, {1, 1});
  const auto made = simplify_to(domain_of(pslg), 10);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::kEmptyDomain);
  EXPECT_EQ(made.error().field, "simplify");
}

TEST(Simplify, GivesTheSameBitsAgain) {
  const Pslg pslg = toothed_shore(300);
  const Made a = simplified(pslg, 1), b = simplified(pslg, 1);
  ASSERT_EQ(a.domain.vertices, b.domain.vertices);
  ASSERT_EQ(a.domain.triangles.size(), b.domain.triangles.size());
  EXPECT_EQ(std::memcmp(a.domain.triangles.data(), b.domain.triangles.data(),
                        a.domain.triangles.size() * sizeof(Domain::Triangle)),
            0);
}

TEST(Simplify, NamesPointsAndSegmentsOfTheInput) {
  const Pslg pslg = toothed_shore(200);
  const Made made = simplified(pslg, 1);
  for (std::size_t v = 0; v < made.domain.vertices.size(); ++v)
    if (made.domain.input_point[v] != kNone)
      EXPECT_EQ(made.domain.vertices[v], pslg.points[made.domain.input_point[v]]);
  for (const Subsegment& s : made.domain.subsegments) ASSERT_LT(s.segment, pslg.segments.size());
}

TEST(Simplify, StopsWhenCancelled) {
  const Domain domain = domain_of(toothed_shore(2000));
  ExecutionContext context;
  context.cancel();
  const auto made =
      simplify(domain, {.share = 1, .edge = [](Point) { return 1.0; }, .region_edge = {kUnbounded}},
               context);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace weft
