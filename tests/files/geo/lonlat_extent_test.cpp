// SPDX-License-Identifier: Apache-2.0
#include "files/geo/lonlat_extent.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace weft::files {
namespace {

Domain ring(std::vector<Point> points) {
  Domain domain;
  domain.points = std::move(points);
  const auto size = static_cast<std::uint32_t>(domain.points.size());
  for (std::uint32_t i = 0; i < size; ++i) domain.segments.push_back({i, (i + 1) % size, 0});
  domain.fill = Domain::Fill::kEvenOdd;
  return domain;
}

Domain box(double west, double south, double east, double north) {
  return ring({{west, south}, {east, south}, {east, north}, {west, north}});
}

std::string projection_of(const Domain& domain) {
  const auto projection = suitable_projection(domain, lonlat_extent(domain).value());
  return projection ? *projection : projection.error().message;
}

std::string refusal(const Domain& domain) {
  const auto extent = lonlat_extent(domain);
  EXPECT_FALSE(extent);
  return extent ? "" : extent.error().message;
}

TEST(LonLatExtents, AreCutInTheWidestGapOfTheLongitudes) {
  const auto plain = lonlat_extent(box(-80, 30, -60, 45)).value();
  EXPECT_EQ(plain.west, -80);
  EXPECT_EQ(plain.width, 20);
  EXPECT_EQ(plain.south, 30);
  EXPECT_EQ(plain.north, 45);
  EXPECT_FALSE(plain.around);
  EXPECT_FALSE(plain.jumps);
}

TEST(LonLatExtents, AreTheSameWhetherLongitudesJumpAtTheDateLineOrGoOn) {
  const auto jumps = lonlat_extent(box(177, -20, -177, -14)).value();
  const auto goes_on = lonlat_extent(box(177, -20, 183, -14)).value();
  const auto before = lonlat_extent(box(-183, -20, -177, -14)).value();
  for (const auto& extent : {jumps, goes_on, before}) {
    EXPECT_EQ(extent.west, 177);
    EXPECT_EQ(extent.width, 6);
    EXPECT_FALSE(extent.around);
    EXPECT_EQ(extent.unwrapped(-177), 183);
    EXPECT_EQ(extent.unwrapped(177), 177);
  }
  EXPECT_TRUE(jumps.jumps);
  EXPECT_FALSE(goes_on.jumps);
}

TEST(LonLatExtents, GoAroundIfSegmentsCrossAllLongitudes) {
  EXPECT_TRUE(lonlat_extent(ring({{0, 80}, {90, 80}, {180, 80}, {-90, 80}})).value().around);
  // The same points, but a ring that turns back and leaves a gap from 180 to 270.
  const auto open =
      lonlat_extent(ring({{0, 80}, {90, 80}, {180, 80}, {90, 70}, {0, 70}, {-90, 80}})).value();
  EXPECT_FALSE(open.around);
  EXPECT_EQ(open.west, -90);
  EXPECT_EQ(open.width, 270);
}

TEST(LonLatExtents, RefuseWhatIsNotInDegreesAndNameThePlace) {
  Domain domain = box(0, 0, 10, 10);
  domain.points[2].y = 91;
  EXPECT_EQ(refusal(domain), "point 2: the latitude 91 is not between -90 and 90 degrees");
  domain.point_places.add(0, "in.poly:", 7, "");
  EXPECT_EQ(refusal(domain), "in.poly:9: the latitude 91 is not between -90 and 90 degrees");
  domain = box(583'960, 0, 583'970, 10);
  EXPECT_EQ(refusal(domain), "point 0: the longitude 583960 is not between -360 and 360 degrees");
  domain = box(0, 0, 10, 10);
  domain.holes.push_back({0, -100});
  EXPECT_EQ(refusal(domain), "hole 0: the latitude -100 is not between -90 and 90 degrees");
  domain.holes.clear();
  domain.regions.push_back({{400, 0}, 1, std::nullopt});
  EXPECT_EQ(refusal(domain), "region 0: the longitude 400 is not between -360 and 360 degrees");
  EXPECT_EQ(refusal(box(-180, -60, 180, 60)),
            "segment 0: the segment goes all around the Earth: divide it, or cut the domain");
  EXPECT_EQ(refusal(Domain{}), "the domain has no points");
}

TEST(SuitableProjections, AreTheOnesThatTheShapeAsksFor) {
  EXPECT_TRUE(
      projection_of(box(-76, 20, -74, 50)).starts_with("+proj=tmerc +lat_0=35 +lon_0=-75 "));
  EXPECT_TRUE(projection_of(box(-100, 38, -60, 42))
                  .starts_with("+proj=lcc +lat_1=40 +lat_0=40 +lon_0=-80 "));
  EXPECT_TRUE(projection_of(box(-20, -2, 20, 2)).starts_with("+proj=merc +lon_0=0 "));
  EXPECT_TRUE(projection_of(box(177, -2, -157, 2)).starts_with("+proj=merc +lon_0=-170 "));
  EXPECT_TRUE(projection_of(ring({{0, 60}, {90, 60}, {180, 60}, {-90, 60}}))
                  .starts_with("+proj=stere +lat_0=90 +lon_0=0 "));
  EXPECT_TRUE(projection_of(ring({{0, -60}, {90, -60}, {180, -60}, {-90, -60}}))
                  .starts_with("+proj=stere +lat_0=-90 +lon_0=0 "));
  // A disc of some 10 degrees around (20, 45).
  EXPECT_TRUE(
      projection_of(
          ring({{20, 35}, {30, 37.5}, {34, 45}, {30, 52}, {20, 55}, {9, 52}, {6, 45}, {10, 37.5}}))
          .starts_with("+proj=stere +lat_0="));
}

TEST(SuitableProjections, AreRefusedForABeltAroundTheEquator) {
  std::vector<Point> south;
  for (int lon = -180; lon < 180; lon += 60) south.push_back({lon * 1.0, -5});
  Domain belt = ring(south);
  const Domain north = ring({{-180, 5}, {-90, 5}, {0, 5}, {90, 5}});
  for (const auto& [a, b, marker, area] : north.segments)
    belt.segments.push_back({a + 6, b + 6, marker});
  belt.points.insert(belt.points.end(), north.points.begin(), north.points.end());
  EXPECT_NE(projection_of(belt).find("cut the domain"), std::string::npos) << projection_of(belt);
}

}  // namespace
}  // namespace weft::files
