// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/dxf_shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "files/formats/domains/dxf.h"
#include "tests/files/support/dxf_text.h"

namespace weft::files {
namespace {

constexpr double kPi = std::numbers::pi;

Domain read(const std::string& entities, const std::string& blocks = "") {
  const auto domain = read_dxf_text("d.dxf", drawing(entities, blocks), {.even_odd = true});
  EXPECT_TRUE(domain) << domain.error().message;
  return domain ? *domain : Domain{};
}

// What the segments enclose, counted with their directions: exact for chords and arcs.
double area(const Domain& domain) {
  double twice = 0;
  auto arc = domain.arcs.begin();
  for (std::size_t s = 0; s < domain.segments.size(); ++s) {
    const Point a = domain.points[domain.segments[s].a];
    const Point b = domain.points[domain.segments[s].b];
    twice += a.x * b.y - a.y * b.x;
    if (arc == domain.arcs.end() || arc->segment != s) continue;
    const double turn = 4 * std::atan((arc++)->bulge);
    const double radius = std::hypot(b.x - a.x, b.y - a.y) / 2 / std::sin(turn / 2);
    twice += radius * radius * (turn - std::sin(turn));
  }
  EXPECT_EQ(arc, domain.arcs.end());
  return twice / 2;
}

double area_of_chords(Domain domain) {
  EXPECT_TRUE(flatten_arcs(domain));
  return area(domain);
}

bool is_one_ring(const Domain& domain) {
  for (std::size_t s = 0; s < domain.segments.size(); ++s) {
    const auto& next = domain.segments[s + 1 < domain.segments.size() ? s + 1 : 0];
    if (domain.points[domain.segments[s].b] != domain.points[next.a]) return false;
  }
  return true;
}

// In radians, between a segment and the next; where one ends without a next, none.
double greatest_kink(const Domain& domain) {
  std::vector<double> bulges(domain.segments.size(), 0);
  for (const Domain::Arc& arc : domain.arcs) bulges[arc.segment] = arc.bulge;
  const auto direction_of = [&](std::size_t s, double turn) {
    const Point a = domain.points[domain.segments[s].a];
    const Point b = domain.points[domain.segments[s].b];
    return std::atan2(b.y - a.y, b.x - a.x) + turn * std::atan(bulges[s]);
  };
  double most = 0;
  for (std::size_t s = 0; s + 1 < domain.segments.size(); ++s)
    if (domain.points[domain.segments[s].b] == domain.points[domain.segments[s + 1].a])
      most = std::max(
          most, std::abs(std::remainder(direction_of(s + 1, -2) - direction_of(s, 2), 2 * kPi)));
  return most;
}

TEST(DxfShape, OfACircleIsTwoArcs) {
  for (const char* circle :
       {"0 CIRCLE 8 0 10 3 20 1 40 0.5 ", "0 ARC 8 0 10 3 20 1 40 0.5 50 0 51 360 ",
        "0 ARC 8 0 10 3 20 1 40 0.5 50 30 51 390 "}) {
    const Domain domain = read(circle);
    ASSERT_EQ(domain.segments.size(), 2u) << circle;
    EXPECT_EQ(domain.arcs, (std::vector<Domain::Arc>{{0, 1}, {1, 1}}));
    EXPECT_EQ(domain.points[0], domain.points[2]);
    EXPECT_NEAR(area(domain), kPi / 4, 1e-15);
    EXPECT_NEAR(area_of_chords(domain), kPi / 4, 1e-3);
  }
  EXPECT_EQ(read("0 CIRCLE 10 3 20 1 40 0.5 ").points[1], (Point{2.5, 1}));
}

TEST(DxfShape, OfAnArcGoesFromItsFirstAngleLeftwardsAcrossZero) {
  const Domain domain = read("0 ARC 10 0 20 0 40 2 50 270 51 90 ");
  EXPECT_EQ(domain.points, (std::vector<Point>{{0, -2}, {0, 2}}));
  EXPECT_EQ(domain.arcs, (std::vector<Domain::Arc>{{0, 1}}));
  const Domain most = read("0 ARC 10 0 20 0 40 2 50 -90 51 -180 ");
  ASSERT_EQ(most.arcs.size(), 2u);
  EXPECT_EQ(most.points.front(), (Point{0, -2}));
  EXPECT_EQ(most.points.back(), (Point{-2, 0}));
  EXPECT_NEAR(area(most), kPi * 4 * 3 / 4, 1e-12);
}

TEST(DxfShape, WithoutALengthIsLeftOut) {
  const auto domain = read_dxf_text(
      "d.dxf",
      drawing("0 LINE 10 0 20 0 11 1 21 0 0 ARC 10 0 20 0 40 1 50 45 51 45 0 CIRCLE 10 0 20 0 40 0 "
              "0 LWPOLYLINE 90 0 70 1 "),
      {});
  ASSERT_TRUE(domain);
  EXPECT_EQ(domain->segments.size(), 1u);
  ASSERT_EQ(domain->warnings.size(), 1u);
  EXPECT_EQ(domain->warnings[0].count, 3u);
}

TEST(DxfShape, OfAPolylineHasItsBulges) {
  // A slot of the length 4 between the centres of its ends, whose radius is 1; a flag says that it
  // is closed, and its last vertex repeats the first.
  const std::string light = " 10 0 20 -1 10 4 20 -1 42 1 10 4 20 1 10 0 20 1 42 1 ";
  const std::string repeated = light + "10 0 20 -1 42 7 ";
  std::string heavy = "0 POLYLINE 66 1 70 1 ";
  for (const char* vertex : {"10 0 20 -1 ", "10 4 20 -1 42 1 ", "10 4 20 1 ", "10 0 20 1 42 1 "})
    heavy += std::string("0 VERTEX 8 0 ") + vertex;
  for (const std::string& entity :
       {"0 LWPOLYLINE 90 4 70 1" + light, "0 LWPOLYLINE 90 5 70 1" + repeated,
        "0 LWPOLYLINE 90 5 70 0" + repeated,
        "0 LWPOLYLINE 90 5 70 1" + light + "10 0.000000001 20 -1 ", heavy + "0 SEQEND "}) {
    const Domain domain = read(entity);
    ASSERT_EQ(domain.segments.size(), 4u) << entity;
    EXPECT_TRUE(is_one_ring(domain)) << entity;
    EXPECT_EQ(domain.arcs, (std::vector<Domain::Arc>{{1, 1}, {3, 1}}));
    EXPECT_DOUBLE_EQ(area(domain), 8 + kPi) << entity;
  }
  EXPECT_EQ(read("0 LWPOLYLINE 90 4 70 0" + light).segments.size(), 3u);
}

TEST(DxfShape, IsStraightWhereABulgeIsNone) {
  for (const char* bulge : {"1e7", "-1e300"}) {
    const auto domain = read_dxf_text("d.dxf",
                                      drawing("0 LWPOLYLINE 70 1 10 0 20 0 42 " +
                                              std::string(bulge) + " 10 4 20 0 42 0.5 10 4 20 2 "),
                                      {});
    ASSERT_TRUE(domain);
    EXPECT_EQ(domain->arcs, (std::vector<Domain::Arc>{{1, 0.5}}));
    ASSERT_EQ(domain->warnings.size(), 1u);
    EXPECT_EQ(domain->warnings[0].text,
              "1 entity of the kind 'LWPOLYLINE', line 46, is straight where a bulge is above 1e6, "
              "or between points that are hardly apart");
  }
  EXPECT_TRUE(read("0 LWPOLYLINE 70 0 10 0 20 0 42 1 10 1e-14 20 0 10 4 20 2 ").arcs.empty());
}

TEST(DxfShape, IsMirroredWhereItsPlaneIsSeenFromBelow) {
  const Domain arc = read("0 ARC 10 1 20 0 40 2 50 0 51 90 210 0 220 0 230 -1 ");
  EXPECT_EQ(arc.points, (std::vector<Point>{{-3, 0}, {-1, 2}}));
  EXPECT_LT(arc.arcs.at(0).bulge, 0);
  EXPECT_NEAR(area(read("0 LWPOLYLINE 70 1 210 0 220 0 230 -1 10 0 20 -1 10 4 20 -1 42 1 10 4 20 1 "
                        "10 0 20 1 42 1 ")),
              -8 - kPi, 1e-12);
  // Lines lie in the plane of the drawing whatever their extrusion.
  EXPECT_EQ(read("0 LINE 10 1 20 2 11 3 21 4 210 0 220 0 230 -1 ").points,
            (std::vector<Point>{{1, 2}, {3, 4}}));
}

TEST(DxfShape, OfABlockIsPlacedScaledMirroredAndTurned) {
  const std::string block =
      "0 BLOCK 8 0 2 slot 10 2 20 0 0 LWPOLYLINE 8 0 70 1 10 0 20 -1 10 4 20 -1 42 1 10 4 20 1 10 "
      "0 20 1 42 1 0 ENDBLK 0 BLOCK 2 pair 10 0 20 0 0 INSERT 2 SLOT 10 0 20 0 0 INSERT 2 slot 10 "
      "0 20 9 41 -1 0 ENDBLK ";
  const double slot = 8 + kPi;
  const Domain turned = read("0 INSERT 2 Slot 10 5 20 5 41 2 42 2 50 90 ", block);
  EXPECT_EQ(turned.points[0], (Point{7, 1}));
  EXPECT_NEAR(area(turned), 4 * slot, 1e-12);
  const Domain mirrored = read("0 INSERT 2 slot 10 0 20 0 42 -1 ", block);
  EXPECT_EQ(mirrored.arcs, (std::vector<Domain::Arc>{{1, -1}, {3, -1}}));
  EXPECT_NEAR(area(mirrored), -slot, 1e-12);
  EXPECT_NEAR(area(read("0 INSERT 2 pair 10 0 20 0 50 30 ", block)), 0, 1e-12);
  const Domain array = read("0 INSERT 2 slot 10 0 20 0 70 3 71 2 44 10 45 20 ", block);
  EXPECT_NEAR(area(array), 6 * slot, 1e-10);
  EXPECT_EQ(array.points.at(5 * 5).x, 18);
  EXPECT_EQ(array.points.at(5 * 5).y, 19);
  const Domain stretched = read("0 INSERT 2 slot 10 0 20 0 42 3 ", block);
  EXPECT_LT(stretched.arcs.size(), 100u);
  EXPECT_NEAR(area(stretched), 3 * slot, 3e-4);
  EXPECT_LT(greatest_kink(stretched), 1e-9);
  const Domain circle =
      read("0 INSERT 2 c 42 3 ", "0 BLOCK 2 c 10 0 20 0 0 CIRCLE 10 0 20 0 40 1 0 ENDBLK ");
  EXPECT_TRUE(is_one_ring(circle));
  EXPECT_NEAR(area(circle), 3 * kPi, 3e-4);
  EXPECT_LT(circle.segments.size(), 100u);
}

TEST(DxfShape, OfAnEllipseIsOfFewArcs) {
  const Domain whole = read("0 ELLIPSE 10 1 20 1 11 4 21 0 40 0.25 41 0 42 6.283185307179586 ");
  EXPECT_TRUE(is_one_ring(whole));
  EXPECT_NEAR(area(whole), 4 * kPi, 3e-4);
  EXPECT_LT(greatest_kink(whole), 1e-9);
  EXPECT_LT(whole.segments.size(), 120u);
  EXPECT_EQ(whole.arcs.size(), whole.segments.size());
  const Domain half = read("0 ELLIPSE 10 0 20 0 11 0 21 2 40 0.5 41 0 42 3.141592653589793 ");
  EXPECT_EQ(half.points.front(), (Point{0, 2}));
  EXPECT_NEAR(half.points.back().y, -2, 1e-15);
  EXPECT_NEAR(area(half), kPi, 1e-4);
  EXPECT_NEAR(
      area(read("0 ELLIPSE 10 0 20 0 11 0 21 2 40 0.5 41 0 42 3.141592653589793 210 0 220 0 "
                "230 -1 ")),
      -kPi, 1e-4);
  const Domain round = read("0 ELLIPSE 10 1 20 1 11 4 21 0 40 1 41 0 42 6.283185307179586 ");
  EXPECT_EQ(round.arcs.size(), 4u);
  EXPECT_NEAR(area(round), 16 * kPi, 1e-13);
}

TEST(DxfShape, OfASplineIsOfFewArcs) {
  // A quarter of a circle as a rational curve of degree 2.
  const Domain quarter = read(
      "0 SPLINE 70 4 71 2 72 6 73 3 40 0 40 0 40 0 40 1 40 1 40 1 41 1 41 0.7071067811865476 41 1 "
      "10 "
      "1 20 0 10 1 20 1 10 0 20 1 ");
  EXPECT_EQ(quarter.points, (std::vector<Point>{{1, 0}, {0, 1}}));
  ASSERT_EQ(quarter.arcs.size(), 1u);
  EXPECT_NEAR(quarter.arcs[0].bulge, std::tan(kPi / 8), 1e-15);
  const Domain cubic = read(
      "0 SPLINE 70 8 71 3 40 0 40 0 40 0 40 0 40 1 40 1 40 1 40 1 10 0 20 0 10 1 20 9 10 2 20 -9 "
      "10 "
      "3 20 0 ");
  EXPECT_LT(greatest_kink(cubic), 1e-9);
  EXPECT_LT(cubic.segments.size(), 120u);
  EXPECT_EQ(cubic.points.back(), (Point{3, 0}));
  EXPECT_EQ(read("0 SPLINE 70 0 71 3 74 3 11 0 21 0 11 1 21 2 11 3 21 0 ").segments.size(), 2u);
  const auto torn = read_dxf_text(
      "d.dxf", drawing("0 LINE 10 0 20 0 11 1 21 0 0 SPLINE 71 3 40 0 40 1 10 0 20 0 10 1 20 1 "),
      {});
  ASSERT_TRUE(torn);
  EXPECT_EQ(torn->segments.size(), 1u);
  EXPECT_EQ(torn->warnings.size(), 1u);
}

TEST(DxfShape, EndsWhereTheLineEndsThatGoesOn) {
  // A plate with a round corner, as programs write it: 16 digits, or a gap of 1e-9.
  for (const std::string corner : {"11 3.7071067811865475 21 1.7071067811865475 ",
                                   "11 3.707106780186 21 1.7071067811865475 "}) {
    const Domain domain = read(
        "0 LINE 10 0 20 0 11 4 21 0 0 LINE 10 4 20 0 11 4 21 1 0 ARC 10 3 20 1 "
        "40 1 50 0 51 45 0 LINE 10 0 20 0 " +
        corner);
    ASSERT_EQ(domain.arcs.size(), 1u);
    const Domain::Segment& arc = domain.segments[domain.arcs[0].segment];
    EXPECT_EQ(domain.points[arc.a], (Point{4, 1}));
    EXPECT_EQ(domain.points[arc.b], domain.points.back());
  }
  // Two arcs, of which none is in the file's digits.
  const Domain arcs =
      read("0 ARC 10 0 20 0 40 1 50 33.3 51 77 0 ARC 10 0 20 0 40 1 50 77 51 151.7 ");
  EXPECT_EQ(arcs.points[1], arcs.points[2]);
  // An arc that is tiny in its drawing stays as it is.
  const Domain tiny = read(
      "0 LINE 10 0 20 0 11 1e6 21 0 0 LINE 10 1.0005 20 0 11 1.0005 21 -1 0 ARC 10 1 20 0 40 1e-3 "
      "50 0 51 90 ");
  EXPECT_EQ(tiny.points[4], (Point{1.001, 0}));
  EXPECT_EQ(tiny.points[5], (Point{1, 1e-3}));
  // A gap that is drawn stays.
  const Domain gap = read("0 LINE 10 0 20 0 11 4 21 0 0 ARC 10 3 20 0 40 1.0001 50 0 51 45 ");
  EXPECT_EQ(gap.points[2], (Point{4.0001, 0}));
}

TEST(DxfShape, OfAnAreaIsAPolygonIfThereAreNoLines) {
  const std::string head = "0 HATCH 10 0 20 0 30 0 2 SOLID 70 1 71 0 91 2 ";
  const std::string tail = "75 0 76 1 98 1 10 1 20 1 ";
  const Domain ring = read(head +
                           "92 3 72 0 73 1 93 4 10 0 20 0 10 8 20 0 10 8 20 8 10 0 20 8 97 0 92 18 "
                           "72 1 73 1 93 2 10 5 20 4 42 1 10 3 20 4 42 1 97 1 330 5 " +
                           tail);
  ASSERT_EQ(ring.areas.size(), 1u);
  EXPECT_NEAR(area(ring), 64 + kPi, 1e-13);
  EXPECT_EQ(ring.arcs, (std::vector<Domain::Arc>{{4, 1}, {5, 1}}));
  const Domain edges = read(
      "0 HATCH 10 0 20 0 2 SOLID 91 1 92 1 93 2 72 2 10 0 20 0 40 2 50 0 51 180 "
      "73 1 72 1 10 -2 20 0 11 2 21 0 97 0 " +
      tail);
  EXPECT_NEAR(area(edges), 2 * kPi, 1e-14);
  const Domain solid = read("0 SOLID 10 0 20 0 11 2 21 0 12 0 22 1 13 2 23 1 ");
  ASSERT_EQ(solid.areas.size(), 1u);
  EXPECT_EQ(area(solid), 2);
  EXPECT_EQ(area(read("0 3DFACE 10 0 20 0 30 1 11 2 21 0 12 2 22 1 13 0 23 1 ")), 2);
  EXPECT_EQ(area(read("0 TRACE 10 0 20 0 11 2 21 0 12 0 22 1 13 0 23 1 ")), 1);
  EXPECT_EQ(read("0 POINT 10 1 20 2 ").points, (std::vector<Point>{{1, 2}}));
}

}  // namespace
}  // namespace weft::files
