// SPDX-License-Identifier: Apache-2.0
// How segments meet: crossings, overlaps, touchings, coincidences.
#include "engine/domain/arrangement/arrangement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "engine/domain/domain.h"
#include "tests/engine/domain/laws.h"
#include "tests/engine/domain/shapes.h"

namespace weft {
namespace {

// The tolerance in units in the last place, as the largest coordinate has them.
constexpr double kTolerance = 8192;

Domain triangulated(const Pslg& pslg, double ulps = 6) {
  const ExecutionContext context;
  Result<Domain> domain = triangulate(pslg, context);
  if (!domain) {
    ADD_FAILURE() << domain.error().field << ": " << domain.error().message;
    return {};
  }
  EXPECT_EQ(broken_law(pslg, *domain), std::nullopt);
  EXPECT_EQ(broken_chain(pslg, *domain, ulps), std::nullopt);
  EXPECT_EQ(broken_origin(pslg, *domain, ulps), std::nullopt);
  return *std::move(domain);
}

// Index of the vertex at p.
std::uint32_t vertex_at(const Domain& domain, Point p) {
  for (std::uint32_t v = 0; v < domain.vertices.size(); ++v)
    if (domain.vertices[v] == p) return v;
  ADD_FAILURE() << "no vertex at (" << p.x << ", " << p.y << ")";
  return kNone;
}

const Subsegment* subsegment(const Domain& domain, Point p, Point q) {
  for (const Subsegment& s : domain.subsegments) {
    const Point a = domain.vertices[s.a], b = domain.vertices[s.b];
    if ((a == p && b == q) || (a == q && b == p)) return &s;
  }
  return nullptr;
}

TEST(Arrangement, OfASquareIsTwoTriangles) {
  const Domain domain = triangulated(square());
  EXPECT_EQ(domain.vertices.size(), 4u);
  EXPECT_EQ(domain.triangles.size(), 2u);
  EXPECT_EQ(domain.subsegments.size(), 4u);
  EXPECT_EQ(domain.regions.size(), 1u);
}

TEST(Arrangement, PutsAVertexWhereSegmentsCross) {
  Pslg pslg = square();
  pslg.segments.push_back({0, 2, 7});
  pslg.segments.push_back({1, 3, 8});
  const Domain domain = triangulated(pslg);
  ASSERT_EQ(domain.vertices.size(), 5u);
  EXPECT_EQ(domain.vertices[4], (Point{0.5, 0.5}));
  EXPECT_EQ(domain.input_point[4], kNone);
  EXPECT_EQ(subsegment(domain, {0, 0}, {0.5, 0.5})->marker, 7);
  EXPECT_EQ(subsegment(domain, {0.5, 0.5}, {0, 1})->marker, 8);
  EXPECT_EQ(subsegment(domain, {0.5, 0.5}, {0, 1})->segment, 5u);
}

TEST(Arrangement, RoundsACrossingToTheNearestDouble) {
  Pslg pslg = square(3);
  add_segment(pslg, {0.5, 1}, {2.5, 2});  // meet at x = 11 / 6, y = 5 / 3
  add_segment(pslg, {2, 1.5}, {1, 2.5});
  const Domain domain = triangulated(pslg);
  vertex_at(domain, {11.0 / 6, 5.0 / 3});
}

TEST(Arrangement, ResolvesAHashOfManyCrossings) {
  Pslg pslg = square(10);
  const int n = 12;
  for (int i = 1; i <= n; ++i) {
    const double t = 10.0 * i / (n + 1);
    add_segment(pslg, {0.3, t}, {9.7, t}, i);
    add_segment(pslg, {t, 0.3}, {t, 9.7}, -i);
  }
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(domain.vertices.size(), 4u + 4 * n + n * n);
  EXPECT_EQ(domain.subsegments.size(), 4u + 2 * n * (n + 1));
}

TEST(Arrangement, ResolvesASlantedHashOfManyCrossings) {
  Pslg pslg;
  add_box(pslg, {-9, -9}, {9, 9});
  const int n = 20;
  const double c = std::cos(0.4), s = std::sin(0.4);
  for (int i = 0; i < n; ++i) {
    const double t = (i - n / 2) * 0.37;
    add_segment(pslg, {-5 * c - t * s, -5 * s + t * c}, {5 * c - t * s, 5 * s + t * c}, i);
    add_segment(pslg, {5 * s + t * c, -5 * c + t * s}, {-5 * s + t * c, 5 * c + t * s}, i);
  }
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(domain.vertices.size(), 4u + 4 * n + n * n);
}

TEST(Arrangement, MergesChordsThatNearlyMeetInOnePoint) {
  Pslg pslg;
  add_box(pslg, {-2, -2}, {2, 2});
  const int n = 40;
  for (int i = 0; i < n; ++i) {
    const double angle = std::numbers::pi * i / n;
    const double x = 1.5 * std::cos(angle), y = 1.5 * std::sin(angle);
    add_segment(pslg, {0.1 + x, 0.2 + y}, {0.1 - x, 0.2 - y}, i);
  }
  const Domain domain = triangulated(pslg, 2 * kTolerance);
  // Rounded, the chords meet pairwise in hundreds of points around (0.1, 0.2).
  EXPECT_LE(domain.vertices.size(), 4u + 2 * n + 20);
}

TEST(Arrangement, StaysDelaunayWhereACrossingIsRoundedOffAShortPiece) {
  // Close to its end a piece's circumcircle is narrower than rounding: a crossing that is inserted
  // as if it lay on the piece would leave an edge that is not Delaunay.
  Pslg pslg;
  add_box(pslg, {-3, -3}, {3, 3});
  add_segment(pslg, {-0x1.b02f90a27ac93p-2, -0x1.3c21fae104564p+0},
              {0x1.05a57dc23863ep+0, 0x1.047763d6e8859p+1});
  add_segment(pslg, {0x1.2b3f84ea304d8p-1, 0x1.9d932e132d102p+0},
              {0x1.fceb9240b964p-7, -0x1.a18cc28cc0869p-1});
  add_segment(pslg, {0x1.5cd5fd8fc80bfp-2, -0x1.9b6c84f082b2dp-1},
              {0x1.099068d69e5a7p-2, 0x1.9a830f450e264p+0});
  add_segment(pslg, {0x1.06ac2db1466f2p-2, -0x1.37bd67a1ce86fp-1},
              {0x1.5fba38b51ff74p-2, 0x1.68ab809db4104p+0});
  const ExecutionContext context;
  const Result<Domain> domain = triangulate(pslg, context);
  ASSERT_TRUE(domain);
  EXPECT_EQ(broken_law(pslg, *domain), std::nullopt);
  EXPECT_EQ(broken_chain(pslg, *domain, 2 * kTolerance), std::nullopt);
}

TEST(Arrangement, NamesTheLowestSegmentOfAnOverlap) {
  Pslg pslg = square(10);
  add_segment(pslg, {1, 5}, {6, 5}, 0);
  add_segment(pslg, {4, 5}, {9, 5}, 3);
  add_segment(pslg, {5, 5}, {2, 5}, 4);
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(subsegment(domain, {1, 5}, {2, 5})->segment, 4u);
  EXPECT_EQ(subsegment(domain, {1, 5}, {2, 5})->marker, 0);
  EXPECT_EQ(subsegment(domain, {2, 5}, {4, 5})->segment, 4u);
  EXPECT_EQ(subsegment(domain, {2, 5}, {4, 5})->marker, 4);
  EXPECT_EQ(subsegment(domain, {4, 5}, {5, 5})->segment, 4u);
  EXPECT_EQ(subsegment(domain, {4, 5}, {5, 5})->marker, 3);
  EXPECT_EQ(subsegment(domain, {6, 5}, {9, 5})->segment, 5u);
}

TEST(Arrangement, KeepsMarkersOfOverlapsAcrossCrossings) {
  Pslg pslg = square(10);
  add_segment(pslg, {1, 5}, {9, 5}, 0);
  add_segment(pslg, {1, 5}, {9, 5}, 6);
  add_segment(pslg, {5, 1}, {5, 9}, 0);
  add_segment(pslg, {9, 5}, {1, 5}, 7);
  const Domain domain = triangulated(pslg);
  for (const double x : {1.0, 9.0}) {
    const Subsegment* s = subsegment(domain, {x, 5}, {5, 5});
    ASSERT_NE(s, nullptr);
    EXPECT_EQ(s->segment, 4u);
    EXPECT_EQ(s->marker, 6);
  }
}

TEST(Arrangement, MergesCoincidentPointsIntoTheLowest) {
  Pslg pslg = square();
  pslg.points.push_back({0.5, 0.5});
  pslg.points.push_back({1, 1});
  pslg.points.push_back({0.5, 0.5});
  pslg.segments.push_back({0, 6});
  pslg.segments.push_back({4, 5});
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(domain.input_point, (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
}

TEST(Arrangement, TakesNegativeZeroForZero) {
  Pslg pslg = square();
  add_segment(pslg, {-0.0, -0.0}, {0.5, 0.25});
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(domain.vertices.size(), 5u);
}

TEST(Arrangement, SplitsASegmentAtAPointOnIt) {
  Pslg pslg = square();
  pslg.points.push_back({0.25, 0});
  const Domain domain = triangulated(pslg);
  EXPECT_NE(subsegment(domain, {0, 0}, {0.25, 0}), nullptr);
  EXPECT_NE(subsegment(domain, {0.25, 0}, {1, 0}), nullptr);
}

TEST(Arrangement, JoinsATJunctionWhoseEndIsRounded) {
  // 0.3 t, 0.1 t is off the segment by less than an ulp: short of it for some t, beyond for others.
  for (int k = 1; k < 10; ++k) {
    SCOPED_TRACE(k);
    Pslg pslg;
    add_box(pslg, {-1, -1}, {2, 2});
    add_segment(pslg, {0, 0}, {0.3, 0.1});
    const double t = k * 0.1;
    add_segment(pslg, {0.3 * t, 0.1 * t}, {0, 1});
    const Domain domain = triangulated(pslg);
    EXPECT_EQ(domain.vertices.size(), 8u);
    EXPECT_NE(subsegment(domain, {0, 0}, {0.3 * t, 0.1 * t}), nullptr);
  }
}

TEST(Arrangement, LeadsASegmentThroughAPointWithinTheToleranceOfIt) {
  Pslg pslg = square();
  pslg.points.push_back({0.5, 0.9 * 0x1p-40});
  const Domain domain = triangulated(pslg, kTolerance);
  EXPECT_EQ(subsegment(domain, {0, 0}, {1, 0}), nullptr);
  EXPECT_EQ(domain.merging.segments, 1u);
  EXPECT_DOUBLE_EQ(domain.merging.farthest, 0.9 * 0x1p-40);
  EXPECT_EQ(domain.merging.farthest_at, pslg.points.back());
}

TEST(Arrangement, LeadsASegmentThroughAllPointsWithinTheToleranceOfItWhereverOthersLeadIt) {
  Pslg pslg = square();
  pslg.snap = 0.01;
  const Point from{0.1, 0.5}, above{0.3, 0.508}, below{0.34, 0.492}, to{0.9, 0.5};
  add_segment(pslg, from, to);
  pslg.points.insert(pslg.points.end(), {above, below});
  const Result<Domain> domain = triangulate(pslg, ExecutionContext());
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(broken_law(pslg, *domain), std::nullopt);
  EXPECT_EQ(broken_separation(pslg, *domain), std::nullopt);
  EXPECT_NE(subsegment(*domain, from, above), nullptr);
  EXPECT_NE(subsegment(*domain, above, below), nullptr);
  EXPECT_NE(subsegment(*domain, below, to), nullptr);
}

// The wall is led to a point that is nearer than half the snap to the end of the door.
TEST(Arrangement, KeepsADoorFartherThanTheSnapFromItsWallApartWhereverOthersLeadTheWall) {
  Pslg pslg = square();
  pslg.snap = 0.01;
  const Point from{0.1, 0.5}, above{0.3, 0.508}, end{0.312, 0.511}, to{0.9, 0.5};
  add_segment(pslg, from, to);
  add_segment(pslg, end, {0.312, 0.9});
  pslg.points.push_back(above);
  const Result<Domain> domain = triangulate(pslg, ExecutionContext());
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(broken_law(pslg, *domain), std::nullopt);
  EXPECT_EQ(broken_separation(pslg, *domain), std::nullopt);
  EXPECT_NE(subsegment(*domain, from, above), nullptr);
  EXPECT_NE(subsegment(*domain, above, to), nullptr);
}

TEST(Arrangement, KeepsAPointFartherThanTheToleranceFromASegmentApart) {
  Pslg pslg = square();
  pslg.points.push_back({0.5, 1.1 * 0x1p-40});
  const Domain domain = triangulated(pslg);
  EXPECT_NE(subsegment(domain, {0, 0}, {1, 0}), nullptr);
  EXPECT_EQ(domain.merging.segments, 0u);
}

TEST(Arrangement, KeepsDanglingSegments) {
  Pslg pslg = square();
  add_segment(pslg, {0.2, 0.2}, {0.7, 0.4}, 5);
  const Domain domain = triangulated(pslg);
  const Subsegment* s = subsegment(domain, {0.2, 0.2}, {0.7, 0.4});
  ASSERT_NE(s, nullptr);
  EXPECT_EQ(s->marker, 5);
}

TEST(Arrangement, MakesIsolatedPointsVertices) {
  Pslg pslg = square();
  pslg.points.push_back({0.3, 0.6});
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(vertex_at(domain, {0.3, 0.6}), 4u);
}

TEST(Arrangement, LeadsHundredsOfSegmentsThroughOneHub) {
  Pslg pslg;
  add_box(pslg, {-2, -2}, {2, 2});
  pslg.points.push_back({0, 0});
  for (std::uint32_t i = 0; i < 500; ++i) {
    const double angle = 2 * std::numbers::pi * i / 500;
    pslg.points.push_back({std::cos(angle), std::sin(angle)});
    pslg.segments.push_back({4, 5 + i, 0});
  }
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(domain.subsegments.size(), 504u);
}

TEST(Arrangement, HoldsAcrossTheWholeRangeOfCoordinates) {
  Pslg pslg;
  add_box(pslg, {-1e50, -1e50}, {1e50, 1e50});
  add_segment(pslg, {-1e-100, -1e-100}, {1e45, 1e45});
  add_segment(pslg, {1e-100, 0}, {0, 1e-100});
  add_segment(pslg, {-1e40, 3}, {1e40, -2});
  const ExecutionContext context;
  const Result<Domain> domain = triangulate(pslg, context);
  ASSERT_TRUE(domain);
  EXPECT_EQ(broken_law(pslg, *domain), std::nullopt);
}

TEST(Arrangement, RefusesMoreSplitsThanItsLimit) {
  Pslg pslg = square(9);
  for (int i = 1; i < 9; ++i) {
    add_segment(pslg, {i * 1.0, 0.5}, {i * 1.0, 8.5});
    add_segment(pslg, {0.5, i * 1.0}, {8.5, i * 1.0});
  }
  const ExecutionContext context;
  StopPoller poller(context);
  EXPECT_NO_THROW(arrange(pslg, poller, 128));  // two for each of 64 crossings
  try {
    arrange(pslg, poller, 127);
    FAIL() << "the limit was not noticed";
  } catch (const Stopped& stopped) {
    EXPECT_EQ(stopped.error.code, ErrorCode::kLimitExceeded);
    EXPECT_EQ(stopped.error.field, "domain.segments");
    EXPECT_EQ(stopped.error.message,
              "the segments cross and overlap more than 127 times, which is the limit");
  }
}

}  // namespace
}  // namespace weft
