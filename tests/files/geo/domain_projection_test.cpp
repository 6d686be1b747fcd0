// SPDX-License-Identifier: Apache-2.0
#include "files/geo/domain_projection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "files/geo/lonlat_extent.h"

namespace weft::files {
namespace {

class DomainProjections : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!Projection::available()) GTEST_SKIP() << "built without PROJ";
  }
  static Domain ring(std::vector<Point> points) {
    Domain domain;
    domain.points = std::move(points);
    const auto size = static_cast<std::uint32_t>(domain.points.size());
    for (std::uint32_t i = 0; i < size; ++i)
      domain.segments.push_back({i, (i + 1) % size, static_cast<std::int32_t>(i) + 1});
    domain.segment_places.add(0, "d.poly:", 10, "");
    return domain;
  }
  static DomainProjection project(Domain& domain, const ProjectionOptions& options = {true}) {
    auto projection = DomainProjection::project(domain, options);
    EXPECT_TRUE(projection) << projection.error().message;
    return std::move(*projection);
  }
  static std::string refusal(Domain domain, const ProjectionOptions& options = {true}) {
    const auto projection = DomainProjection::project(domain, options);
    EXPECT_FALSE(projection);
    return projection ? "" : projection.error().message;
  }
};

TEST_F(DomainProjections, BringPointsToTheNearestOfAGrid) {
  const std::vector<Point> lonlat = {{-74.46374390128042, 40.1}, {-74.1, 40.12345}, {-74.2, 40.3}};
  const Point inside{-74.25, 40.15};
  Domain domain = ring(lonlat);
  domain.holes.push_back(inside);
  domain.regions.push_back({inside, 7, std::nullopt});
  const auto projection = project(domain);
  const auto plane = Projection::make(projection.name());
  ASSERT_TRUE(plane);
  const auto expect_nearest = [&plane](Point at, Point degrees) {
    const Point exact = plane->forward(degrees);
    EXPECT_EQ(at.x, std::nearbyint(exact.x * 1024) / 1024);
    EXPECT_EQ(at.y, std::nearbyint(exact.y * 1024) / 1024);
  };
  ASSERT_EQ(domain.points.size(), lonlat.size());
  for (std::size_t i = 0; i < lonlat.size(); ++i) expect_nearest(domain.points[i], lonlat[i]);
  expect_nearest(domain.holes[0], inside);
  expect_nearest(domain.regions[0].at, inside);
  expect_nearest(projection.to_plane(inside), inside);
  EXPECT_EQ(domain.snap, 2. / 1024);
  EXPECT_EQ(projection.named_place(domain.points[2]), lonlat[2]);
}

TEST_F(DomainProjections, GiveVerticesOfTheInputBackBitForBit) {
  const std::vector<Point> lonlat = {{-74.46374390128042, 40.1},
                                     {-74.1, 40.123456789012345},
                                     {-74.2, 40.3},
                                     {-74.4, 1.0 / 3 + 40}};
  Domain domain = ring(lonlat);
  domain.regions.push_back({{-74.3, 40.2}, 7, 5e6});
  const auto projection = project(domain);
  ASSERT_EQ(domain.points.size(), 4u);
  EXPECT_EQ(domain.regions[0].max_area, 5e6);
  EXPECT_NEAR(projection.to_lonlat(domain.regions[0].at).x, -74.3, 1e-8);

  // Vertex 0 is no input point, vertex 5 one that was moved.
  Mesh mesh;
  mesh.coordinates = {100, 200};
  for (const Point& at : domain.points)
    mesh.coordinates.insert(mesh.coordinates.end(), {at.x, at.y});
  mesh.coordinates.insert(mesh.coordinates.end(), {domain.points[3].x + 1, domain.points[3].y});
  MeshView view = mesh.view();
  const std::vector<std::uint32_t> input_points = {1, 0, 2, 1, 3, 2, 4, 3, 5, 3};
  view.input_points = input_points;
  const auto back = projection.to_lonlat(view);
  ASSERT_TRUE(back);
  ASSERT_EQ(back->size(), 12u);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ((Point{(*back)[2 * i + 2], (*back)[2 * i + 3]}), lonlat[i]);
  EXPECT_EQ((Point{(*back)[0], (*back)[1]}), projection.to_lonlat({100, 200}));
  EXPECT_NE((*back)[10], lonlat[3].x);
  EXPECT_NEAR((*back)[10], lonlat[3].x, 1e-4);
}

TEST_F(DomainProjections, DivideLongSegmentsOnTheirStraightLineInDegrees) {
  const std::vector<Point> lonlat = {{-80, 30}, {-60, 30}, {-60, 30.05}, {-80, 30.05}};
  Domain domain = ring(lonlat);
  domain.point_markers = {1, 2, 3, 4};
  domain.areas.resize(1);
  for (Domain::Segment& segment : domain.segments) segment.area = 1;
  const auto projection = project(domain);
  const std::size_t points = domain.points.size();
  EXPECT_GT(points, 20u);
  EXPECT_LT(points, 400u);
  EXPECT_EQ(domain.point_markers.size(), points);
  EXPECT_EQ(domain.segments.size(), points);  // still a ring
  std::vector<int> ends(points);
  for (std::size_t i = 0; i < domain.segments.size(); ++i) {
    const auto& [a, b, marker, area] = domain.segments[i];
    EXPECT_EQ(area, 1u);
    ++ends[a];
    ++ends[b];
    const std::string place = domain.segment_places.locate(i);
    EXPECT_EQ(place, "d.poly:" + std::to_string(9 + marker));
    if (b >= 4) {
      EXPECT_EQ(domain.point_places.locate(b), place);
    }
    // The middle of a piece strays from the parallel by a thousandth of its length at most.
    if (marker != 1) continue;
    const Point from = domain.points[a];
    const Point to = domain.points[b];
    const Point middle = projection.to_lonlat({(from.x + to.x) / 2, (from.y + to.y) / 2});
    const double length =
        std::sqrt((to.x - from.x) * (to.x - from.x) + (to.y - from.y) * (to.y - from.y));
    EXPECT_LT(std::abs(middle.y - 30) * 111'000, 1.01e-3 * length);
    EXPECT_NEAR(projection.to_lonlat(to).y, 30, 1e-8);
  }
  EXPECT_EQ(std::count(ends.begin(), ends.end(), 2), static_cast<std::ptrdiff_t>(points));
}

// Two fields at a wall of the third, whose corner is in the middle of it.
TEST_F(DomainProjections, DivideSegmentsWhereCornersLieOnThem) {
  const std::vector<Point> lonlat = {{10, 60},        {10.05, 60},    {10.05, 60.05}, {10, 60.05},
                                     {10.025, 60.05}, {10.025, 60.1}, {10, 60.1}};
  Domain domain = ring({lonlat.begin(), lonlat.begin() + 4});
  domain.points = lonlat;
  domain.segments.insert(domain.segments.end(), {{3, 4, 5}, {4, 5, 6}, {5, 6, 7}, {6, 3, 8}});
  project(domain);
  EXPECT_EQ(domain.points.size(), lonlat.size());
  ASSERT_EQ(domain.segments.size(), 9U);
  EXPECT_EQ(domain.segments[2], (Domain::Segment{2, 4, 3}));
  EXPECT_EQ(domain.segments[8], (Domain::Segment{4, 3, 3}));
  EXPECT_EQ(domain.segment_places.locate(8), domain.segment_places.locate(2));
}

TEST_F(DomainProjections, DivideASegmentAlikeInBothDirections) {
  Domain domain = ring({{-3.1234567, 30.3}, {17.7654321, 37.1}, {7, 42}});
  domain.segments.push_back({1, 0, 9});
  project(domain);
  std::vector<std::pair<double, double>> there;
  std::vector<std::pair<double, double>> back;
  for (const auto& [a, b, marker, area] : domain.segments) {
    if (marker == 1) there.emplace_back(domain.points[b].x, domain.points[b].y);
    if (marker == 9) back.emplace_back(domain.points[a].x, domain.points[a].y);
  }
  std::sort(there.begin(), there.end());
  std::sort(back.begin(), back.end());
  EXPECT_GT(there.size(), 10u);
  EXPECT_EQ(there, back);
}

TEST_F(DomainProjections, AreTheSamePlaneOnBothSidesOfTheDateLine) {
  Domain jumps = ring({{177, -20}, {-177, -20}, {-177, -14}, {177, -14}});
  Domain goes_on = ring({{177, -20}, {183, -20}, {183, -14}, {177, -14}});
  const auto jumping = project(jumps);
  const auto going_on = project(goes_on);
  EXPECT_EQ(jumping.name(), going_on.name());
  EXPECT_EQ(jumps.points, goes_on.points);
  const auto [least, greatest] =
      std::minmax_element(jumps.points.begin(), jumps.points.end(),
                          [](const Point& a, const Point& b) { return a.x < b.x; });
  EXPECT_NEAR(greatest->x - least->x, 6 * 111'320 * std::cos(14 * M_PI / 180), 10'000);
  // Longitudes of new vertices go on as those of the file do.
  const Point east = jumping.to_lonlat({100'000, 0});
  EXPECT_LT(east.x, -178);
  EXPECT_NEAR(going_on.to_lonlat({100'000, 0}).x, east.x + 360, 1e-12);
  EXPECT_EQ(jumping.warnings().size(), 1u);
  EXPECT_TRUE(going_on.warnings().empty());
}

TEST_F(DomainProjections, WarnOfAnglesAndLengthsThatDoNotHold) {
  const std::vector<Point> lonlat = {{-80, 30}, {-79, 30}, {-79, 31}};
  Domain domain = ring(lonlat);
  EXPECT_TRUE(project(domain).warnings().empty());
  domain = ring(lonlat);
  const auto albers = project(domain, {.crs = "EPSG:5070"}).warnings();
  ASSERT_EQ(albers.size(), 1u);
  EXPECT_TRUE(
      albers[0].starts_with("'EPSG:5070' is not conformal: angles on the ground differ by "))
      << albers[0];
  domain = ring(lonlat);
  const auto mercator = project(domain, {.crs = "EPSG:3395"}).warnings();
  ASSERT_EQ(mercator.size(), 1u);
  EXPECT_TRUE(mercator[0].starts_with("lengths in the plane are 1.15")) << mercator[0];
}

TEST_F(DomainProjections, RefuseAPointThatTheProjectionDoesNotTake) {
  Domain domain = ring({{-70, 10}, {-60, 10}, {15, 0}});
  domain.point_places.add(0, "d.poly:", 2, "");
  EXPECT_EQ(refusal(domain, {.crs = "EPSG:32618"}),
            "d.poly:4: (15, 0) is outside of what 'EPSG:32618' projects");
}

TEST_F(DomainProjections, RefuseMorePointsOnLongSegmentsThanAMillion) {
  Domain domain = ring({{0, 10}, {120, 70}, {10, 80}});
  for (int i = 0; i < 20'000; ++i) domain.segments.push_back({0, 1, 0});
  EXPECT_NE(refusal(domain).find("more than 1,000,000 points"), std::string::npos);
}

TEST_F(DomainProjections, RefuseMorePointsOnSegmentsThanAMillion) {
  constexpr std::uint32_t kPoints = 1500;
  Domain domain;
  for (std::uint32_t i = 0; i < kPoints; ++i) domain.points.push_back({10 + 0.01 * i, 50});
  for (std::uint32_t i = 0; i < kPoints; ++i) domain.segments.push_back({0, kPoints - 1, 0});
  EXPECT_NE(
      refusal(domain).find("points on segments that these would be divided more than 1,000,000"),
      std::string::npos);
}

TEST_F(DomainProjections, RefuseMorePointsNearSegmentsThanCanBeLookedAt) {
  constexpr std::uint32_t kPoints = 5000;
  Domain domain;
  for (std::uint32_t i = 0; i < kPoints; ++i) domain.points.push_back({10 + 1e-12 * i, 50});
  domain.points.push_back({11, 51});
  for (std::uint32_t i = 0; i < kPoints; ++i) domain.segments.push_back({0, kPoints, 0});
  EXPECT_NE(refusal(domain).find("points near segments that more than 20,000,000 pairs"),
            std::string::npos);
}

// What the file's segments are within `snap` of, not what the plane makes of them.
TEST_F(DomainProjections, DivideSegmentsAtCornersThatWillBeMerged) {
  const double off = 0.05 / kMetresPerDegree;
  const std::vector<Point> lonlat = {{10, 60}, {10.2, 60}, {10.1, 60.1}, {10.1, 60 + off}};
  for (const double snap : {0., 0.06}) {
    Domain domain = ring({lonlat.begin(), lonlat.begin() + 3});
    domain.points.push_back(lonlat[3]);
    domain.segments.push_back({2, 3, 7});
    ASSERT_TRUE(DomainProjection::project(domain, {true}, snap));
    EXPECT_EQ(domain.snap, snap > 0 ? snap : kProjectedSnap);
    EXPECT_EQ(domain.segments.size(), snap > 0 ? 5U : 4U);
  }
}

}  // namespace
}  // namespace weft::files
