// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/carve.h"

#include <gtest/gtest.h>

#include <set>

#include "engine/domain/domain.h"
#include "tests/engine/domain/laws.h"
#include "tests/engine/domain/shapes.h"

namespace weft {
namespace {

Domain triangulated(const Pslg& pslg) {
  const ExecutionContext context;
  Result<Domain> domain = triangulate(pslg, context);
  if (!domain) {
    ADD_FAILURE() << domain.error().field << ": " << domain.error().message;
    return {};
  }
  EXPECT_EQ(broken_law(pslg, *domain), std::nullopt);
  return *std::move(domain);
}

void expect_error(const Pslg& pslg, ErrorCode code, const std::string& field,
                  const std::string& message) {
  const ExecutionContext context;
  const Result<Domain> domain = triangulate(pslg, context);
  ASSERT_FALSE(domain);
  EXPECT_EQ(domain.error().code, code);
  EXPECT_EQ(domain.error().field, field);
  EXPECT_EQ(domain.error().message, message);
}

// The region that the triangle around p names; p must lie in the interior of one.
Region region_at(const Domain& domain, Point p) {
  for (const Domain::Triangle& t : domain.triangles) {
    const Domain one{domain.vertices, {}, {t}, {}, {}, {}, {}, {}, {}};
    if (cover(one, p) == 1) return domain.regions[t.region];
  }
  ADD_FAILURE() << "no triangle at (" << p.x << ", " << p.y << ")";
  return {};
}

// Three nested squares of sides 6, 4 and 2.
Pslg nested() {
  Pslg pslg;
  for (const double r : {3.0, 2.0, 1.0}) add_box(pslg, {-r, -r}, {r, r});
  return pslg;
}

TEST(Seeds, KeepEveryBoundedFace) {
  EXPECT_EQ(area(triangulated(nested())), 36);
}

TEST(Seeds, CarveTheFaceThatAHoleFloods) {
  Pslg pslg = nested();
  pslg.holes = {{1.5, 0.1}};
  EXPECT_EQ(area(triangulated(pslg)), 36 - 12);
}

TEST(Seeds, MayNameTheSameHoleTwice) {
  Pslg pslg = nested();
  pslg.holes = {{1.5, 0.1}, {-1.5, 0.1}};
  EXPECT_EQ(area(triangulated(pslg)), 36 - 12);
}

TEST(Seeds, RemoveTheOutsideOfAConcaveBoundary) {
  Pslg pslg;
  add_ring(pslg, {{0, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}});
  EXPECT_EQ(area(triangulated(pslg)), 10);
}

TEST(Seeds, KeepSeveralComponents) {
  Pslg pslg;
  add_box(pslg, {0, 0}, {1, 1});
  add_box(pslg, {3, 0}, {5, 1});
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(area(domain), 3);
  EXPECT_EQ(domain.triangles.size(), 4u);
}

TEST(Seeds, CarveHolesThatTouchInAPoint) {
  Pslg pslg = square(6);
  add_ring(pslg, {{1, 3}, {2, 2}, {3, 3}, {2, 4}});
  add_ring(pslg, {{3, 3}, {4, 2}, {5, 3}, {4, 4}});
  pslg.holes = {{2, 3}, {4, 3}};
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(area(domain), 36 - 4);
  EXPECT_EQ(cover(domain, {3, 2.25}), 1);
  EXPECT_EQ(cover(domain, {3.5, 3.1}), 0);
}

TEST(Seeds, CarveAHoleThatTouchesTheBoundary) {
  Pslg pslg = square(4);
  add_ring(pslg, {{2, 0}, {3, 1}, {2, 2}, {1, 1}});
  pslg.holes = {{2, 1.1}};
  EXPECT_EQ(area(triangulated(pslg)), 14);
}

TEST(Seeds, LeaveAnIslandInAHole) {
  Pslg pslg = nested();
  pslg.holes = {{1.5, 0.1}};
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(cover(domain, {0.1, 0.2}), 1);
  EXPECT_EQ(cover(domain, {1.5, 0.2}), 0);
  EXPECT_EQ(cover(domain, {2.5, 0.2}), 1);
}

TEST(Seeds, DropWhatLiesInHolesAndOutside) {
  Pslg pslg = square(4);
  add_box(pslg, {1, 1}, {3, 3});
  pslg.holes = {{2, 2}};
  pslg.points.push_back({2.5, 2.5});
  pslg.points.push_back({9, 9});
  add_segment(pslg, {1.2, 1.4}, {1.4, 1.2});
  add_segment(pslg, {6, 6}, {7, 7});
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(domain.input_point, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(domain.subsegments.size(), 8u);
}

TEST(Seeds, FloodUpToASegmentThatTouchesFromADanglingEnd) {
  Pslg pslg = square(4);
  add_segment(pslg, {0, 2}, {3, 2});  // does not divide the square
  pslg.regions = {{.at = {2, 1}, .id = 4, .max_area = {}}};
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(region_at(domain, {1.01, 3.1}).id, 4);
}

TEST(HoleSeed, OutsideTheConvexHullIsRefused) {
  Pslg pslg = square();
  pslg.holes = {{5, 5}};
  expect_error(pslg, ErrorCode::kSeedOutsideDomain, "domain.holes[0]",
               "the seed (5, 5) lies outside: no segments enclose it");
}

TEST(HoleSeed, InABayOfTheBoundaryIsRefused) {
  Pslg pslg;
  add_ring(pslg, {{0, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}});
  pslg.holes = {{2, 2}};
  expect_error(pslg, ErrorCode::kSeedOutsideDomain, "domain.holes[0]",
               "the seed (2, 2) lies outside: no segments enclose it");
}

TEST(HoleSeed, OnASegmentIsRefused) {
  Pslg pslg = nested();
  pslg.holes = {{1.5, 0}, {2, 0.5}};
  expect_error(pslg, ErrorCode::kSeedOnSegment, "domain.holes[1]",
               "the seed (2, 0.5) lies on a segment, so it does not tell which face it means");
}

TEST(HoleSeed, OnAPointIsRefused) {
  Pslg pslg = nested();
  pslg.holes = {{1, 1}};
  expect_error(pslg, ErrorCode::kSeedOnSegment, "domain.holes[0]",
               "the seed (1, 1) lies on a point, so it does not tell which face it means");
}

TEST(HoleSeed, ThatCarvesEverythingAwayIsRefused) {
  Pslg pslg = square();
  pslg.holes = {{0.5, 0.25}};
  expect_error(
      pslg, ErrorCode::kEmptyDomain, "domain.holes[0]",
      "the holes carve everything away (1 given): the seed (0.5, 0.25) floods the last face");
}

TEST(EmptyDomain, WhereThereAreNoSegments) {
  Pslg pslg = square();
  pslg.segments.clear();
  expect_error(pslg, ErrorCode::kEmptyDomain, "domain.segments",
               "no face is enclosed by segments (0 given), so there is nothing to mesh");
}

Pslg united() {
  Pslg pslg;
  pslg.fill = Fill::kUnion;
  return pslg;
}

TEST(Areas, ThatOverlapAreUnited) {
  Pslg pslg = united();
  add_area_box(pslg, {0, 0}, {4, 3});
  add_area_box(pslg, {3, 1}, {7, 3});
  EXPECT_EQ(area(triangulated(pslg)), 12 + 8 - 2);
  pslg.fill = Fill::kEvenOdd;
  EXPECT_EQ(area(triangulated(pslg)), 12 + 8 - 4);
}

TEST(Areas, GivenTwiceAreMeshedOnce) {
  Pslg pslg = united();
  add_area_box(pslg, {0, 0}, {4, 3}, {.region = 1});
  add_area_box(pslg, {0, 0}, {4, 3}, {.region = 2});
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(area(domain), 12);
  EXPECT_EQ(region_at(domain, {1, 2}).id, 1);
  pslg.fill = Fill::kEvenOdd;
  expect_error(pslg, ErrorCode::kEmptyDomain, "domain.areas",
               "the fill and the holes leave nothing of the areas (2 given)");
}

TEST(Areas, GiveTheRegionOfTheSmallestAndTheLeastBound) {
  Pslg pslg = united();
  add_area_box(pslg, {0, 0}, {10, 10}, {.region = 1, .max_area = 0.5});
  add_area_box(pslg, {2, 2}, {4, 4}, {.region = 2, .max_area = 3});
  add_area_box(pslg, {1, 1}, {8, 8}, {.max_area = 0.25});  // has no region to give
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(area(domain), 100);
  EXPECT_EQ(region_at(domain, {3, 3.1}).id, 2);
  EXPECT_EQ(region_at(domain, {3, 3.1}).max_area, 0.25);
  EXPECT_EQ(region_at(domain, {6, 6.1}).id, 1);
  EXPECT_EQ(region_at(domain, {6, 6.1}).max_area, 0.25);
  EXPECT_EQ(region_at(domain, {9, 9.1}).max_area, 0.5);
}

TEST(Areas, OfAHigherPriorityComeFirst) {
  Pslg pslg = united();
  add_area_box(pslg, {0, 0}, {10, 10}, {.region = 1, .priority = 1});
  add_area_box(pslg, {2, 2}, {4, 4}, {.region = 2});
  EXPECT_EQ(region_at(triangulated(pslg), {3, 3.1}).id, 1);
}

TEST(Areas, AreCarvedByAreasThatAreHoles) {
  Pslg pslg = united();
  add_area_box(pslg, {0, 0}, {10, 10});
  add_area_box(pslg, {1, 1}, {3, 3}, {.is_hole = true});
  add_area_box(pslg, {2, 2}, {4, 4}, {.is_hole = true});
  add_area_box(pslg, {2.5, 2.5}, {6, 6}, {.region = 3});
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(area(domain), 100 - 7);
  EXPECT_EQ(region_at(domain, {5, 5.1}).id, 3);
}

TEST(Areas, HaveHolesOfTheirOwn) {
  Pslg pslg = united();
  add_box(pslg, {0, 0}, {10, 10});
  add_box(pslg, {2, 2}, {8, 8});
  add_area(pslg, 0, {.region = 1});
  add_area_box(pslg, {3, 3}, {5, 5}, {.region = 2});
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(area(domain), 100 - 36 + 4);
  EXPECT_EQ(region_at(domain, {4, 4.1}).id, 2);
}

TEST(Areas, ThatALineCutsKeepTheirRegionOnBothSides) {
  Pslg pslg = united();
  add_area_box(pslg, {0, 0}, {10, 6}, {.region = 7, .max_area = 0.05});
  add_segment(pslg, {-1, 2}, {11, 3});
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(area(domain), 60);
  for (const Point p : {Point{5, 1}, Point{5, 5}}) {
    EXPECT_EQ(region_at(domain, p).id, 7);
    EXPECT_EQ(region_at(domain, p).max_area, 0.05);
  }
}

TEST(Areas, GiveWayToTheMarkersOfLines) {
  Pslg pslg = united();
  add_box(pslg, {0, 0}, {2, 2}, 1);
  add_area(pslg, 0, {});
  add_segment(pslg, {0, 0}, {1, 0}, 5);
  std::set<std::int32_t> below;
  for (const Subsegment& s : triangulated(pslg).subsegments) below.insert(s.marker);
  EXPECT_EQ(below, (std::set<std::int32_t>{1, 5}));
}

TEST(Areas, GiveRegionsToAllFacesOfSegments) {
  Pslg pslg;
  add_box(pslg, {0, 0}, {2, 2});
  add_area_box(pslg, {1, 0}, {3, 2}, {.region = 4});
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(area(domain), 6);
  EXPECT_EQ(region_at(domain, {0.5, 0.6}).id, 0);
  EXPECT_EQ(region_at(domain, {1.5, 1.6}).id, 4);
}

TEST(Areas, GiveWayToSeeds) {
  Pslg pslg = united();
  add_area_box(pslg, {0, 0}, {2, 2}, {.region = 1, .max_area = 0.5});
  add_area_box(pslg, {1, 0}, {3, 2}, {.region = 2});
  pslg.regions = {{{0.5, 0.5}, 9, {}}};
  pslg.holes = {{2.5, 1.1}};
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(area(domain), 4);
  EXPECT_EQ(region_at(domain, {0.5, 0.6}).id, 9);
  EXPECT_EQ(region_at(domain, {0.5, 0.6}).max_area, 0.5);
}

TEST(Areas, AreRefusedUnlessTheyClose) {
  Pslg pslg = united();
  add_area_box(pslg, {0, 0}, {2, 2});
  pslg.segments.pop_back();
  expect_error(pslg, ErrorCode::kBadOption, "domain.areas[0]",
               "the segments of area 0 do not close to rings: an odd number of them ends at point "
               "0, (0, 0)");
  pslg = united();
  add_area_box(pslg, {0, 0}, {2, 2}, {.max_area = -1});
  expect_error(pslg, ErrorCode::kBadOption, "domain.areas[0].max_area",
               "the maximum area is -1; it must be finite and above 0");
  pslg.areas.clear();
  expect_error(pslg, ErrorCode::kIndexOutOfRange, "domain.segment_areas[0]",
               "segment 0 is part of the border of area 0, but there are 0 areas");
  expect_error(
      [] {
        Pslg none = square();
        none.fill = Fill::kUnion;
        return none;
      }(),
      ErrorCode::kEmptyDomain, "domain.areas", "there are no areas to unite");
}

TEST(EmptyDomain, WhereSegmentsEncloseNothing) {
  Pslg pslg = square();
  pslg.segments.pop_back();
  expect_error(pslg, ErrorCode::kEmptyDomain, "domain.segments",
               "no face is enclosed by segments (3 given), so there is nothing to mesh");
}

TEST(EmptyDomain, WhereEveryRingIsDoubled) {
  Pslg pslg = square();
  add_box(pslg, {0, 0}, {1, 1});
  pslg.fill = Fill::kEvenOdd;
  expect_error(pslg, ErrorCode::kEmptyDomain, "domain.segments",
               "by the even-odd rule nothing is inside: every face is enclosed an even number of "
               "times");
}

// A ring about (x, y), half as wide and high as said.
Pslg with_box(Pslg pslg, double x, double y, double width, double height) {
  add_box(pslg, {x - width, y - height}, {x + width, y + height});
  return pslg;
}

TEST(Merging, ClosesAFaceThinnerThanTheTolerance) {
  Pslg pslg = with_box(square(), 0.5, 0.5, 0.2, 0.004);
  EXPECT_EQ(triangulated(pslg).merging.vanished_faces, 0u);
  pslg.snap = 0.01;
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(domain.merging.vanished_faces, 1u);
  EXPECT_NEAR(domain.merging.vanished_at.y, 0.5, 0.01);
  EXPECT_EQ(domain.merging.points, 2u);
  EXPECT_NEAR(domain.merging.farthest, 0.008, 1e-9);
  EXPECT_DOUBLE_EQ(area(domain), 1);
}

TEST(Merging, CountsEveryLoopThatBecomesAVertex) {
  Pslg pslg = with_box(with_box(square(), 0.5, 0.5, 0.001, 0.001), 0.2, 0.7, 0.002, 0.001);
  pslg.snap = 0.01;
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(domain.merging.vanished_faces, 2u);
  EXPECT_EQ(domain.merging.vanished_at, (Point{0.499, 0.499}));
  EXPECT_EQ(domain.merging.points, 6u);
}

TEST(Merging, CountsNoFaceForOverlapsAndJunctions) {
  Pslg pslg = square();
  add_segment(pslg, {0.25, 0}, {0.75, 0});
  add_segment(pslg, {0.5, 0.005}, {0.5, 0.8});
  pslg.snap = 0.01;
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(domain.merging.vanished_faces, 0u);
  EXPECT_EQ(domain.merging.segments, 2u);  // both that lie on y = 0
}

TEST(Merging, JoinsRoomsThatAreDrawnWithARoundedGap) {
  for (const Fill fill : {Fill::kSeeds, Fill::kEvenOdd}) {
    Pslg pslg;
    pslg.fill = fill;
    pslg.snap = 1e-3;
    add_box(pslg, {0, 0}, {1, 1});
    add_box(pslg, {1.0004, -0.0003}, {2, 1.0002});
    const Domain domain = triangulated(pslg);
    EXPECT_NEAR(area(domain), 2, 1e-3);
    EXPECT_EQ(domain.merging.points, 2u);
    EXPECT_EQ(domain.merging.vanished_faces, 1u);  // the two walls, with nothing between
  }
}

TEST(Merging, ThatClosesTheDomainIsRefused) {
  Pslg thin;
  add_box(thin, {0, 0}, {1, 0.001});
  thin.snap = 0.01;
  const char* const message =
      "merging what is nearer than 0.01 has closed the domain, so there is nothing to mesh";
  expect_error(thin, ErrorCode::kEmptyDomain, "domain.segments", message);
  Pslg small = square(0.001);
  small.snap = 0.01;
  expect_error(small, ErrorCode::kEmptyDomain, "domain.segments", message);
}

TEST(HoleSeed, InAFaceThatVanishesIsRefused) {
  Pslg pslg = with_box(square(), 0.5, 0.5, 0.001, 0.001);
  pslg.snap = 0.01;
  pslg.holes = {{0.5, 0.5}};
  expect_error(pslg, ErrorCode::kSeedOnSegment, "domain.holes[0]",
               "the seed (0.5, 0.5) is nearer than 0.01 to a segment or point, so its face may "
               "have changed or vanished when what is so near was merged");
}

TEST(RegionSeed, FloodsItsFaceOnly) {
  Pslg pslg = nested();
  pslg.regions = {{.at = {0, 0.5}, .id = -5, .max_area = 0.25},
                  {.at = {2.5, 0.5}, .id = 9, .max_area = {}}};
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(region_at(domain, {0.1, 0.2}).id, -5);
  EXPECT_EQ(region_at(domain, {0.1, 0.2}).max_area, 0.25);
  EXPECT_EQ(region_at(domain, {1.5, 0.2}).id, 0);
  EXPECT_EQ(region_at(domain, {2.5, 0.2}).id, 9);
  EXPECT_EQ(region_at(domain, {2.5, 0.2}).max_area, std::numeric_limits<double>::infinity());
}

TEST(RegionSeed, FindsEachCellOfACheckerboard) {
  const int n = 20;
  Pslg pslg = square(n);
  for (int i = 1; i < n; ++i) {
    add_segment(pslg, {i * 1.0, 0}, {i * 1.0, n * 1.0});
    add_segment(pslg, {0, i * 1.0}, {n * 1.0, i * 1.0});
  }
  for (int x = 0; x < n; ++x)
    for (int y = 0; y < n; ++y)
      pslg.regions.push_back({.at = {x + 0.5, y + 0.5}, .id = x * n + y, .max_area = {}});
  const Domain domain = triangulated(pslg);
  std::vector<int> triangles(n * n, 0);
  for (const Domain::Triangle& t : domain.triangles) {
    const Point a = domain.vertices[t.vertex[0]], b = domain.vertices[t.vertex[1]],
                c = domain.vertices[t.vertex[2]];
    const int x = static_cast<int>((a.x + b.x + c.x) / 3);
    const int y = static_cast<int>((a.y + b.y + c.y) / 3);
    EXPECT_EQ(domain.regions[t.region].id, x * n + y);
    ++triangles[x * n + y];
  }
  EXPECT_EQ(triangles, std::vector<int>(n * n, 2));
}

TEST(RegionSeed, LaterWinsOverEarlierInOneFace) {
  Pslg pslg = square();
  pslg.regions = {{.at = {0.5, 0.25}, .id = 1, .max_area = 3},
                  {.at = {0.25, 0.5}, .id = 2, .max_area = {}}};
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(region_at(domain, {0.1, 0.05}).id, 2);
}

TEST(RegionSeed, InAHoleIsRefused) {
  Pslg pslg = nested();
  pslg.holes = {{0, 0.5}};
  pslg.regions = {{.at = {1.5, 0}, .id = 1, .max_area = {}},
                  {.at = {0.5, 0.25}, .id = 2, .max_area = {}}};
  expect_error(pslg, ErrorCode::kSeedOutsideDomain, "domain.regions[1]",
               "the seed (0.5, 0.25) lies in a hole");
}

TEST(RegionSeed, OutsideIsRefused) {
  Pslg pslg = square();
  pslg.regions = {{.at = {-1, 0.5}, .id = 1, .max_area = {}}};
  expect_error(pslg, ErrorCode::kSeedOutsideDomain, "domain.regions[0]",
               "the seed (-1, 0.5) lies outside: no segments enclose it");
}

TEST(RegionSeed, OnASegmentIsRefused) {
  Pslg pslg = square();
  pslg.regions = {{.at = {0, 0.5}, .id = 1, .max_area = {}}};
  expect_error(pslg, ErrorCode::kSeedOnSegment, "domain.regions[0]",
               "the seed (0, 0.5) lies on a segment, so it does not tell which face it means");
}

TEST(RegionSeed, OnAnEdgeThatIsNoSegmentIsTaken) {
  Pslg pslg = square();
  pslg.regions = {{.at = {0.5, 0.5}, .id = 3, .max_area = {}}};
  EXPECT_EQ(region_at(triangulated(pslg), {0.4, 0.1}).id, 3);
}

TEST(EvenOdd, AlternatesBetweenNestedRings) {
  Pslg pslg = nested();
  pslg.fill = Fill::kEvenOdd;
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(area(domain), 36 - 16 + 4);
  EXPECT_EQ(cover(domain, {1.5, 0.1}), 0);
}

TEST(EvenOdd, CarvesHoleSeedsOnTop) {
  Pslg pslg = nested();
  pslg.fill = Fill::kEvenOdd;
  pslg.holes = {{0, 0.5}};
  EXPECT_EQ(area(triangulated(pslg)), 36 - 16);
}

TEST(EvenOdd, LeavesOutWhereTwoRingsOverlap) {
  Pslg pslg;
  add_box(pslg, {0, 0}, {2, 2});
  add_box(pslg, {1, 1}, {3, 3});
  pslg.fill = Fill::kEvenOdd;
  EXPECT_EQ(area(triangulated(pslg)), 6);
}

TEST(EvenOdd, CancelsAnEdgeThatTwoRingsShare) {
  Pslg pslg;
  add_box(pslg, {0, 0}, {1, 1}, 1);
  add_box(pslg, {1, 0}, {2, 1}, 2);
  pslg.fill = Fill::kEvenOdd;
  const Domain domain = triangulated(pslg);
  EXPECT_EQ(area(domain), 2);
  EXPECT_EQ(domain.subsegments.size(), 7u);  // the shared edge stays in the mesh
}

TEST(EvenOdd, IgnoresADanglingSegment) {
  Pslg pslg = square(4);
  add_segment(pslg, {1, 1}, {6, 2});
  pslg.fill = Fill::kEvenOdd;
  EXPECT_DOUBLE_EQ(area(triangulated(pslg)), 16);
}

TEST(EvenOdd, TakesTheRayThatCrossesTheFewestWhereAChordDividesARing) {
  Pslg pslg = square(4);
  pslg.segments.push_back({0, 2});
  pslg.fill = Fill::kEvenOdd;
  EXPECT_EQ(area(triangulated(pslg)), 16);
}

}  // namespace
}  // namespace weft
