// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/arcs/chords.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "engine/domain/arcs/arc.h"
#include "engine/domain/arcs/arc_meeting.h"
#include "engine/domain/arcs/flat_arcs.h"
#include "tests/engine/domain/arcs/arc_shapes.h"

namespace weft {
namespace {

constexpr double k40Degrees = 40 * kPi / 180;

Chords chords_of(const Pslg& pslg, double max_turn = k40Degrees) {
  const ExecutionContext context;
  StopPoller poller(context);
  return cut_arcs(pslg, max_turn, poller);
}

std::vector<ArcPiece> pieces_of(const Chords& chords) {
  std::vector<ArcPiece> pieces;
  const std::vector<double> bulges = bulges_of(chords.pslg);
  for (std::size_t i = 0; i < chords.segment.size(); ++i) {
    const Segment& s = chords.pslg.segments[i];
    pieces.emplace_back(s.a, s.b, chords.pslg.points[s.a], chords.pslg.points[s.b], bulges[i]);
  }
  return pieces;
}

// Pairs of pieces whose hulls meet elsewhere than at a common end, but for contacts.
int hulls_that_meet(const Chords& chords) {
  const std::vector<ArcPiece> pieces = pieces_of(chords);
  int count = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (std::size_t j = i + 1; j < pieces.size(); ++j) {
      const ArcPiece &p = pieces[i], &q = pieces[j];
      if (p.bulge == 0 && q.bulge == 0) continue;
      const bool at_start = p.a == q.a || p.a == q.b, at_end = p.b == q.a || p.b == q.b;
      if (at_start && at_end) {
        count += std::fabs(p.bulge) != std::fabs(q.bulge);
      } else if ((at_start || at_end) && leave_together(p, q, at_start ? p.a : p.b)) {
        EXPECT_NEAR(length(p.to - p.from), length(q.to - q.from), 1e-14);
      } else {
        count += hulls_meet(p, q);
      }
    }
  }
  return count;
}

TEST(Chords, ACircleOfTwoArcsHasEqualParts) {
  Pslg pslg;
  add_circle(pslg, {0, 0}, 1, 2);
  const Chords chords = chords_of(pslg);
  ASSERT_EQ(chords.segment.size(), 10U);
  for (const ArcPiece& piece : pieces_of(chords)) {
    EXPECT_NEAR(length(piece.to - piece.from), 2 * std::sin(kPi / 10), 1e-15);
    EXPECT_NEAR(length(piece.from - Point{0, 0}), 1, 1e-15);
  }
  EXPECT_EQ(chords.pslg.arcs.size(), 10U);
}

TEST(Chords, AnArcOfNearlyAllOfACircleIsDividedBeforeItsEndsMerge) {
  for (const double gap : {1e-2, 1e-4, 1e-6}) {
    Pslg pslg;
    pslg.points = {{1, 0}, {std::cos(gap), std::sin(gap)}};
    add_arc(pslg, 0, 1, -1 / std::tan(gap / 4));
    pslg.snap = 1e-5;
    const Chords chords = chords_of(pslg);
    EXPECT_GE(chords.segment.size(), 10U) << gap;
    std::set<std::uint32_t> vertices;
    for (const Segment& s : chords.pslg.segments) vertices.insert({s.a, s.b});
    EXPECT_EQ(vertices.size() == chords.segment.size(), gap < pslg.snap) << "a ring";
    for (const ArcPiece& piece : pieces_of(chords))
      EXPECT_NEAR(length(piece.from - Point{0, 0}), 1, 1e-15 / gap + 1e-6 * (gap < pslg.snap))
          << gap;
  }
}

TEST(Chords, HullsOfThinRingsAreApart) {
  for (const double width : {0.1, 1e-2, 1e-3}) {
    Pslg pslg;
    add_circle(pslg, {0, 0}, 1);
    add_circle(pslg, {0, 0}, 1 + width, 3);
    const Chords chords = chords_of(pslg);
    EXPECT_EQ(hulls_that_meet(chords), 0) << width;
    EXPECT_LE(chords.segment.size(), 14 / std::sqrt(width)) << width;
  }
}

TEST(Chords, ArcsThatCrossAreCutThere) {
  Pslg pslg;
  add_circle(pslg, {0, 0}, 1);
  add_circle(pslg, {1, 0}, 1);
  add_segment(pslg, {-2, 0.1}, {3, 0.3});
  const Chords chords = chords_of(pslg);
  EXPECT_EQ(hulls_that_meet(chords), 0);
  std::set<std::uint32_t> line;
  for (std::size_t i = 0; i < chords.segment.size(); ++i)
    if (chords.segment[i] == 8) line.insert(chords.pslg.segments[i].b);
  EXPECT_EQ(line.size(), 5U);
  const auto top = [&](Point p) { return length(p - Point{0.5, std::sqrt(0.75)}) < 1e-15; };
  EXPECT_EQ(std::count_if(chords.pslg.points.begin(), chords.pslg.points.end(), top), 1);
}

TEST(Chords, AHalfCircleThatIsCutNearItsEndStaysOnItsCircle) {
  for (const double angle : {1e-4, 1e-3, 1e-2, 0.1, 1.0}) {
    Pslg pslg;
    add_circle(pslg, {0, 0}, 1, 2);
    add_segment(pslg, {std::cos(angle), std::sin(angle)}, {2, 2});
    for (const ArcPiece& piece : pieces_of(chords_of(pslg))) {
      if (piece.bulge == 0) continue;
      EXPECT_NEAR(length(piece.from - Point{0, 0}), 1, 1e-14) << angle;
      EXPECT_NEAR(length(middle_of_arc(piece.from, piece.to, piece.bulge) - Point{0, 0}), 1, 1e-14)
          << angle;
    }
  }
}

TEST(Chords, AnEndOnAnArcIsAVertexOfIt) {
  Pslg pslg;
  add_circle(pslg, {0, 0}, 1);
  add_segment(pslg, {std::cos(1), std::sin(1)}, {2, 2});
  const Chords chords = chords_of(pslg);
  EXPECT_EQ(hulls_that_meet(chords), 0);
  int arms = 0;
  for (const Segment& s : chords.pslg.segments) arms += s.a == 4 || s.b == 4;
  EXPECT_EQ(arms, 3);
}

TEST(Chords, AnArcDrawnTwiceIsOne) {
  Pslg pslg;
  add_circle(pslg, {0, 0}, 1, 2);
  pslg.segments.push_back({1, 0, 7});  // the first once more, the other way round
  pslg.arcs.push_back({2, -1});
  add_circle(pslg, {0, 0}, 1, 3);  // and from other points
  const Chords chords = chords_of(pslg);
  EXPECT_EQ(hulls_that_meet(chords), 0);
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Segment& s : chords.pslg.segments) edges.insert(std::minmax(s.a, s.b));
  std::set<std::uint32_t> vertices;
  for (const auto& [a, b] : edges) vertices.insert({a, b});
  EXPECT_EQ(edges.size(), vertices.size()) << "one ring";
}

TEST(Chords, PiecesThatTouchEndAtOneDistance) {
  for (const double radius : {0.5, 0.9, 0.999, -0.5, -3.0}) {  // from inside, from outside
    Pslg pslg;
    add_circle(pslg, {0, 0}, 1);
    add_circle(pslg, {1 - radius, 0}, std::fabs(radius), 4, radius < 0 ? kPi : 0);
    const Chords chords = chords_of(pslg);
    EXPECT_EQ(hulls_that_meet(chords), 0) << radius;
    EXPECT_LE(chords.segment.size(), 400U) << radius;
  }
}

TEST(Chords, TouchingWithoutACommonPointIsFound) {
  Pslg pslg;
  add_box(pslg, {-2, 0}, {2, 3});
  add_circle(pslg, {0, 1}, 1, 4, 0.3);
  const Chords chords = chords_of(pslg);
  EXPECT_EQ(hulls_that_meet(chords), 0);
  const auto touches = [](Point p) { return length(p - Point{0, 0}) < 1e-7; };
  EXPECT_EQ(std::count_if(chords.pslg.points.begin(), chords.pslg.points.end(), touches), 1);
}

TEST(Chords, SeedsAndVerticesLieBesideTheHulls) {
  Pslg pslg;
  add_circle(pslg, {0, 0}, 1);
  const Point inside{0.999 * std::cos(0.7), 0.999 * std::sin(0.7)};
  const Point outside{1.0001 * std::cos(0.7), 1.0001 * std::sin(0.7)};
  pslg.regions.push_back({.at = inside, .id = 1, .max_area = {}});
  pslg.points.push_back(outside);
  const Chords chords = chords_of(pslg);
  for (const ArcPiece& piece : pieces_of(chords)) {
    EXPECT_FALSE(piece.hull_is_near(inside, 0));
    EXPECT_FALSE(piece.hull_is_near(outside, 0));
  }
}

TEST(Chords, RandomArcsKeepApart) {
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    const Pslg pslg = random_arcs(seed);
    EXPECT_EQ(hulls_that_meet(chords_of(pslg)), 0) << "seed " << seed;
  }
}

// The error that ends the cutting, in 32 MiB; kCancelled if none does.
ErrorCode end_of_cutting(const Pslg& pslg) {
  const ExecutionContext context(Budget{.max_bytes = 1 << 25});
  StopPoller poller(context);
  try {
    cut_arcs(pslg, k40Degrees, poller);
    return ErrorCode::kCancelled;
  } catch (const Stopped& stopped) {
    return stopped.error.code;
  }
}

TEST(Chords, TwoVerticesAcrossAnArcDoNotSendItBackAndForth) {
  Pslg pslg;
  add_circle(pslg, {0, 0}, 300, 2);
  for (const Point p : {Point{-176.78, 193.01}, {-218.14, 183.81}, {-157.44, 124.97}})
    pslg.points.push_back(p);
  for (const std::uint32_t i : {0u, 1u, 2u}) pslg.segments.push_back({2 + i, 2 + (i + 1) % 3});
  pslg.snap = 20;
  EXPECT_EQ(end_of_cutting(pslg), ErrorCode::kBadOption);
  pslg.snap = 10;
  EXPECT_EQ(end_of_cutting(pslg), ErrorCode::kCancelled);
}

TEST(Chords, RandomArcsEndWhateverIsMerged) {
  int cut = 0, too_near = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Pslg pslg = random_arcs(seed);
    for (const double snap : {0.01, 0.1, 0.3}) {
      pslg.snap = snap;
      const ErrorCode end = end_of_cutting(pslg);
      cut += end == ErrorCode::kCancelled;
      too_near += end == ErrorCode::kBadOption;
      EXPECT_TRUE(end == ErrorCode::kCancelled || end == ErrorCode::kBadOption)
          << "seed " << seed << ", snap " << snap;
    }
  }
  EXPECT_GT(cut, 300);
  EXPECT_GT(too_near, 100);
}

TEST(Chords, SegmentsThatArcsMeetStayStraight) {
  for (const double snap : {0., 0.02}) {
    Pslg pslg;
    add_circle(pslg, {0, 0}, 1);
    add_segment(pslg, {-2, 0.3}, {2, 0.5});
    pslg.points.push_back({0.9, 0.46});  // 0.015 from the segment, 0.011 from the circle
    pslg.snap = snap;
    const Chords chords = chords_of(pslg);
    int pieces = 0;
    for (std::size_t i = 0; i < chords.segment.size(); ++i) pieces += chords.segment[i] == 4;
    EXPECT_EQ(pieces, 3) << snap;
    for (const Arc& arc : chords.pslg.arcs) EXPECT_LT(chords.segment[arc.segment], 4u) << snap;
  }
}

TEST(Chords, PolylinesHaveEqualPartsOfTwoDegrees) {
  Pslg pslg;
  add_circle(pslg, {0, 0}, 1, 2);
  add_segment(pslg, {0, 0}, {0.5, 0}, 3);
  pslg.arcs.push_back({99, 1});  // no such segment: the engine says so, estimates come first
  const Pslg flat = flatten_arcs(pslg);
  ASSERT_EQ(flat.segments.size(), 181U);
  EXPECT_EQ(flat.segments.back().marker, 3);
  for (std::size_t i = 0; i < 180; ++i) {
    const Point a = flat.points[flat.segments[i].a], b = flat.points[flat.segments[i].b];
    EXPECT_NEAR(length(b - a), 2 * std::sin(kPi / 180), 1e-14);
    EXPECT_NEAR(length(a - Point{0, 0}), 1, 1e-14);
  }
  EXPECT_EQ(count_chords(pslg), 180U);
  EXPECT_EQ(flatten_arcs(pslg, kPi / 3).segments.size(), 7U);
  EXPECT_EQ(flatten_arcs(pslg, 2 * kPi).segments.size(), 3U);
}

TEST(Chords, TheDomainKnowsItsArcsByTheInput) {
  Pslg pslg;
  add_box(pslg, {-2, -2}, {2, 2});
  add_circle(pslg, {0, 0}, 1, 2);
  const ExecutionContext context;
  const Result<Domain> domain = triangulate(pslg, context, 40);
  ASSERT_TRUE(domain);
  ASSERT_EQ(domain->curvatures.size(), domain->subsegments.size());
  int arcs = 0;
  for (std::size_t i = 0; i < domain->subsegments.size(); ++i) {
    const Subsegment& s = domain->subsegments[i];
    EXPECT_LT(s.segment, 6U);
    EXPECT_NEAR(std::fabs(domain->curvatures[i]), s.segment >= 4 ? 1 : 0, 1e-14);
    if (s.segment < 4) continue;
    ++arcs;
    const Point a = domain->vertices[s.a], b = domain->vertices[s.b];
    EXPECT_EQ(domain->curvatures[i] > 0, cross(a - Point{0, 0}, b - Point{0, 0}) > 0);
  }
  EXPECT_EQ(arcs, 10);
  for (std::size_t v = 0; v < domain->vertices.size(); ++v)
    EXPECT_EQ(domain->input_point[v] == kNone, v >= 6) << v;
}

TEST(Chords, ArcsNearerThanCanBeToldApartAreNamed) {
  Pslg pslg;
  add_circle(pslg, {0, 0}, 1);
  add_circle(pslg, {0, 0}, 1.25, 4, 0.4);
  pslg.snap = 0.1;
  const ExecutionContext context;
  const Result<Domain> domain = triangulate(pslg, context);
  ASSERT_FALSE(domain);
  EXPECT_EQ(domain.error().code, ErrorCode::kBadOption);
  EXPECT_NE(domain.error().message.find("the arc of segment"), std::string::npos)
      << domain.error().message;
  EXPECT_EQ(domain.error().field.rfind("domain.segments[", 0), 0U) << domain.error().field;
}

}  // namespace
}  // namespace weft
