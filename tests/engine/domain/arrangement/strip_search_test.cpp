// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/arrangement/strip_search.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "engine/domain/arrangement/line_probe.h"
#include "engine/domain/arrangement/snapping.h"
#include "engine/domain/triangulation/triangulation.h"
#include "engine/domain/validate.h"

namespace weft {
namespace {

double uniform(std::mt19937& random) {
  return random() / 4294967296.0;
}

// A segment from (0, 0) to (1, 0) in a crowd of points, some of them just above or below it.
struct Crowd {
  explicit Crowd(unsigned seed, double nearest) {
    std::mt19937 random(seed);
    points = {{0, 0}, {1, 0}};
    while (points.size() < 60) {
      const double y = uniform(random) < 0.5 ? 8 * nearest * (uniform(random) - 0.5)
                                             : 2 * (uniform(random) - 0.5);
      const Point p{1.4 * uniform(random) - 0.2, y};
      bool is_far = true;
      for (const Point q : points) is_far = is_far && distance(p, q) > nearest;
      if (is_far) points.push_back(p);
    }
    t.build(points, 0, 1, 2);
    LineProbe probe(t, t.vertex_of(0), t.vertex_of(1));
    LineProbe::Sees sees = LineProbe::Sees::kNothingYet;
    while (sees == LineProbe::Sees::kNothingYet) sees = probe.turn();
    segment = probe.edge();
    if (sees == LineProbe::Sees::kCrossing)
      segment = t.insert_edge(t.vertex_of(0), t.vertex_of(1), segment);
    t.constrain(segment, 0);
  }

  std::vector<Point> points;
  const ExecutionContext context;
  StopPoller poller{context};
  Triangulation t{poller};
  Triangulation::Edge segment;
};

// What a face says without a search is what a search with the least spacing finds.
TEST(StripSearch, KnowsNoMoreOfWideSpacedVerticesThanASearch) {
  int clear = 0, found = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    constexpr double kSpacing = 0.02;
    const Crowd crowd(seed, kSpacing);
    for (const auto side : {crowd.segment, crowd.t.mirror(crowd.segment)}) {
      StopPoller poller(crowd.context);
      // The height is a fortieth of the spacing.
      StripSearch quick(crowd.t, kSpacing / 40, poller), thorough(crowd.t, kSpacing / 40, poller);
      quick.set_spacing(kSpacing);
      const bool is_clear = quick.is_clear(side);
      EXPECT_EQ(quick.is_clear(side.face), is_clear || crowd.t.is_infinite(side.face));
      const auto nearest = thorough.nearest(side, [](auto) { return true; });
      found += nearest != Triangulation::kInfinite;
      if (!is_clear) continue;
      ++clear;
      EXPECT_EQ(nearest, Triangulation::kInfinite) << seed;
    }
  }
  EXPECT_GT(clear, 20);
  EXPECT_GT(found, 0);
}

TEST(StripSearch, PassesOverVerticesThatAreNotAskedFor) {
  int second = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    const Crowd crowd(seed, 0.02);
    StopPoller poller(crowd.context);
    StripSearch search(crowd.t, 0.01, poller);
    const auto first = search.nearest(crowd.segment, [](auto) { return true; });
    if (first == Triangulation::kInfinite) continue;
    const auto next = search.nearest(crowd.segment, [&](auto v) { return v != first; });
    EXPECT_NE(next, first) << seed;
    second += next != Triangulation::kInfinite;
  }
  EXPECT_GT(second, 0);
}

}  // namespace
}  // namespace weft
