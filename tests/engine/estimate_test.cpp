// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "engine/parallel/mesh_plan.h"
#include "engine/refine/quality_bounds.h"
#include "weft/weft.h"

namespace weft {
namespace {

constexpr std::uint64_t kMegabyte = 1'000'000;
constexpr double kBytesPerRun = 1e6;

Pslg box(double low, double high) {
  return {.points = {{low, low}, {high, low}, {high, high}, {low, high}},
          .segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
}

// A square of area 16.
MeshRequest square(SizeSpec size = {}) {
  return {.pslg = box(0, 4), .size = std::move(size)};
}

// The same with a square of area 4 in it.
MeshRequest nested(SizeSpec size) {
  MeshRequest request = square(std::move(size));
  for (const Point p : box(1, 3).points) request.pslg.points.push_back(p);
  for (const Segment& s : box(1, 3).segments) request.pslg.segments.push_back({s.a + 4, s.b + 4});
  return request;
}

double bytes_of(const MeshRequest& request) {
  return static_cast<double>(estimate(request).bytes);
}

// Triangles times the bound over the area.
const double kOnLattice = 1.48 * triangles_per_bound(LatticeShape::for_angle(20));
const double kAtCircumcentres = 1.16 * triangles_per_bound({});
constexpr double kIfItVaries = 1.1;

// Of fragments that wait for their reader, 24 leaves at the most.
double of_waiting(double triangles) {
  return 22 * std::min(triangles, 24 * leaf_triangles_for(triangles));
}
// Of a mesh that is held as a whole.
double of_whole(double triangles) {
  return 48 * triangles + of_waiting(triangles);
}

// Of the lattices of a size that varies.
double of_lattices(double triangles) {
  return std::min(5 * triangles, 8e6);
}

TEST(Estimate, GrowsWithTheTrianglesThatTheSizeAsksFor) {
  for (const double triangles : {1e6, 1e7}) {
    MeshRequest request = square(16 * kAtCircumcentres / triangles);
    request.min_angle_deg = 35;
    EXPECT_NEAR(bytes_of(request), of_whole(triangles) + kBytesPerRun, 1e5);
    EXPECT_NEAR(static_cast<double>(estimate(request).triangles), triangles, 20);
    request.min_angle_deg = 20;
    request.placement = Placement::kCircumcentre;
    EXPECT_NEAR(static_cast<double>(estimate(request).triangles), triangles, 20);
  }
}

TEST(Estimate, OfAMeshThatStreamsIsThatOfAStrip) {
  MeshRequest request = square(16 * kOnLattice / 1e8);
  const double streams = bytes_of(request);
  const double of_leaf = leaf_triangles_for(1e8);
  EXPECT_NEAR(
      streams,
      420 * std::sqrt(1e8 * of_leaf) + 2700 * 1e8 / of_leaf + of_waiting(1e8) + kBytesPerRun, 1e6);
  request.size = 16 * kOnLattice / 4e8;
  EXPECT_LT(bytes_of(request), 2.5 * streams);
  // Nothing is sent before the end.
  EXPECT_GT(static_cast<double>(estimate(request, {.max_triangles = 1'000'000'000}).bytes),
            48 * 4e8);
  request.min_angle_deg = kMaxStreamingAngleDeg + 0.1;
  EXPECT_GT(bytes_of(request), 48 * 4e8);
}

TEST(Estimate, GrowsWithTheEdgesThatLengthsAtMarkersAskFor) {
  MeshRequest request{.pslg = box(0, 1), .size = 1.0, .min_angle_deg = 35};
  for (std::size_t i = 0; i < 4; ++i) request.pslg.segments[i].marker = std::array{1, 2, 3, 2}[i];
  SizeAt& at = request.size.at.emplace_back(SizeAt{3, 1e-6});  // so many edges on one side
  EXPECT_NEAR(bytes_of(request), of_whole(4e6), 0.1 * of_whole(4e6));
  at.marker = 2;
  EXPECT_NEAR(bytes_of(request), of_whole(8e6), 0.1 * of_whole(8e6));
  request.size.gradation = 0.5;
  EXPECT_NEAR(bytes_of(request), of_whole(16e6), 0.1 * of_whole(16e6));
  request.size.gradation = 0;
  at.marker = 4;  // no segment has it, which a run refuses
  EXPECT_LT(bytes_of(request), 2e6);
  at = {3, 1e-300};
  EXPECT_EQ(estimate(request, {.max_bytes = 1u << 30}).bytes, 1u << 30);
}

TEST(Estimate, LeavesOutHolesAndWhatIsOutsideAndCountsRegions) {
  const double square = 16 * kOnLattice / 1e-4;
  MeshRequest request = nested(1e-4);
  const auto expect_near = [&](double triangles, double tolerance) {
    EXPECT_NEAR(bytes_of(request) - kBytesPerRun, of_whole(triangles),
                tolerance * of_whole(triangles));
  };
  expect_near(square, 0.02);
  MeshRequest even_odd = request;
  request.pslg.holes = {{2, 2}};
  expect_near(0.75 * square, 0.04);
  even_odd.pslg.fill = Fill::kEvenOdd;
  EXPECT_EQ(bytes_of(even_odd), bytes_of(request));
  request.pslg.holes.clear();
  request.pslg.regions = {{.at = {2, 2}, .max_area = 2e-5}};
  expect_near(2 * kIfItVaries * square, 0.05);
}

TEST(Estimate, OfAreasIsThatOfWhatTheyCoverByTheBoundThere) {
  MeshRequest request{.size = 1e-4};
  Pslg& pslg = request.pslg;
  pslg.fill = Fill::kUnion;
  const auto add_box = [&](double low, double high) {
    const auto first = static_cast<std::uint32_t>(pslg.points.size());
    const auto area = static_cast<std::uint32_t>(pslg.areas.size());
    for (const Point p : box(low, high).points) pslg.points.push_back(p);
    for (const Segment& s : box(low, high).segments)
      pslg.segments.push_back({first + s.a, first + s.b, 0, area});
    pslg.areas.emplace_back();
  };
  add_box(0, 4);
  add_box(0, 4);  // once more
  add_box(1, 3);
  const auto expect_near = [&](double triangles, double tolerance) {
    EXPECT_NEAR(bytes_of(request) - kBytesPerRun, of_whole(triangles),
                tolerance * of_whole(triangles));
  };
  const double square = 16 * kOnLattice * 1e4;
  expect_near(square, 0.02);
  pslg.areas[2].is_hole = true;
  expect_near(0.75 * square, 0.04);
  pslg.areas[2].is_hole = false;
  pslg.fill = Fill::kEvenOdd;
  expect_near(0.25 * square, 0.2);  // so does the border of what is left out
  pslg.fill = Fill::kUnion;
  pslg.areas[2].max_area = 2.5e-5;
  expect_near((0.75 + 4 * 0.25) * kIfItVaries * square, 0.2);  // cells at the border count as finer
}

TEST(Estimate, OfAnExpressionIsThatOfItsMean) {
  EXPECT_EQ(bytes_of(square("1e-4")), bytes_of(square("x < 100 ? 1e-4 : 1")));
  EXPECT_EQ(bytes_of(square("1e-4")), bytes_of(square(1e-4)));
  // Half of the square asks for a hundred times as much as the other half.
  EXPECT_NEAR(bytes_of(square("x < 2 ? 1e-5 : 1e-3")) - bytes_of(square("1")),
              of_whole(0.505 * 16 * kOnLattice * kIfItVaries * 1e5) +
                  of_lattices(0.505 * 16 * kOnLattice * kIfItVaries * 1e5),
              1.0 * kMegabyte);
}

TEST(Estimate, OfALengthOfEdgesIsThatOfItsTriangles) {
  MeshRequest by_edge = square(0.01);
  by_edge.size.measure = Measure::kEdge;
  EXPECT_EQ(bytes_of(by_edge), bytes_of(square(area_of_edge(0.01))));
}

TEST(Estimate, OfARasterIsThatOfTheMeanOfItsValuesAndTheirOwn) {
  Raster raster{.dx = 1, .dy = 1, .columns = 1'000'000, .rows = 1};
  for (int i = 0; i < 1'000'000; ++i) raster.values.push_back(i < 500'000 ? 1e-5 : 1e-3);
  EXPECT_NEAR(
      bytes_of(square(raster)) - bytes_of(square("1")),
      of_whole(0.505 * 16 * kOnLattice * 1e5) + of_lattices(0.505 * 16 * kOnLattice * 1e5) + 16e6,
      1.0 * kMegabyte);
  for (double& edge : raster.values) edge = edge == 1e-5 ? 0.005 : 0.05;
  MeshRequest by_edge = square(raster);
  by_edge.size.measure = Measure::kEdge;
  const double per_area = 0.5 / area_of_edge(0.005) + 0.5 / area_of_edge(0.05);
  EXPECT_NEAR(bytes_of(by_edge) - bytes_of(square("1")),
              of_whole(per_area * 16 * kOnLattice) + of_lattices(per_area * 16 * kOnLattice) + 16e6,
              1.0 * kMegabyte);
}

TEST(Estimate, CountsWhatItTakesToMakeFields) {
  MeshRequest request = square("1");
  FieldRaster depth{.dx = 1, .dy = 1, .columns = 1000, .rows = 1000};
  depth.values.resize(1'000'000);
  request.size.fields.push_back({"depth", depth});
  EXPECT_GT(bytes_of(request), bytes_of(square("1")) + 4e6);
}

TEST(Estimate, IsAtMostWhatTheRunMayTake) {
  MeshRequest request = square(1e-12);
  request.min_angle_deg = 35;
  EXPECT_EQ(estimate(request, {.max_bytes = 30 * kMegabyte}).bytes, 30 * kMegabyte);
  EXPECT_EQ(estimate(request, {.triangle_limit = 1'000'000}).triangles, 1'000'000u);
  const Estimate capped = estimate(request, {.max_triangles = 1000});
  EXPECT_EQ(capped.triangles, 1000u);
  EXPECT_LT(capped.bytes, 2 * kMegabyte);
}

TEST(Estimate, OfARequestThatMakesNoSenseIsFinite) {
  constexpr std::uint64_t kMax = std::uint64_t{4} << 30;
  const auto is_finite = [&](const MeshRequest& request) {
    return estimate(request, {.triangle_limit = kMax, .max_bytes = kMax}).bytes <= kMax;
  };
  for (const char* expression : {"0", "-1", "1/0", "sqrt(-1)", "x +"})
    EXPECT_TRUE(is_finite(square(expression))) << expression;
  MeshRequest request = square();
  request.pslg.points[0] = {std::numeric_limits<double>::quiet_NaN(),
                            std::numeric_limits<double>::infinity()};
  request.pslg.segments.push_back({9, 10, 0, 11});
  EXPECT_TRUE(is_finite(request));
  EXPECT_TRUE(is_finite({}));
  EXPECT_TRUE(is_finite(square(Raster{})));
}

}  // namespace
}  // namespace weft
