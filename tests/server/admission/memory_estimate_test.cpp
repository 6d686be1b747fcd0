// SPDX-License-Identifier: Apache-2.0
#include "server/admission/memory_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/server/harness.h"

namespace weft::server::testing {
namespace {

constexpr std::uint64_t kMegabyte = 1'000'000;

// For a square of area 16.
std::uint64_t estimate_of(const char* expression) {
  v1::GenerateMeshRequest request = valid_request();
  request.mutable_size()->set_expression(expression);
  return expected_bytes(request, {});
}

// Triangles times the bound over the area.
constexpr double kOnLattice = 1.5357;

constexpr double kIfItVaries = 1.1;

constexpr double kBytesPerRun = 1e6;

// Of parts that wait for their reader, 24 leaves at the most.
double of_waiting(double triangles, double of_leaf) {
  return 22 * std::min(triangles, 24 * of_leaf);
}
// Of a mesh of at most 2 M triangles that is held as a whole.
double of_whole(double triangles) {
  return 48 * triangles + of_waiting(triangles, 16'000);
}

TEST(Estimate, GrowsWithTheTrianglesThatTheSizeAsksFor) {
  v1::GenerateMeshRequest request = valid_request();
  request.mutable_quality()->set_min_angle_deg(35);
  request.mutable_size()->set_constant(16 * 1.8 / 1e6);
  EXPECT_NEAR(static_cast<double>(expected_bytes(request, {})), of_whole(1e6) + kBytesPerRun, 1e5);
  request.mutable_size()->set_constant(16 * 1.8 / 1e7);
  EXPECT_NEAR(static_cast<double>(expected_bytes(request, {})),
              480e6 + of_waiting(1e7, 6'000) + kBytesPerRun, 1e5);
}

TEST(Estimate, OfAMeshThatStreamsIsThatOfAStrip) {
  v1::GenerateMeshRequest request = valid_request();
  request.mutable_size()->set_constant(16 * kOnLattice / 1e8);
  const auto streams = static_cast<double>(expected_bytes(request, {}));
  EXPECT_NEAR(
      streams,
      420 * std::sqrt(1e8 * 6000) + 2700 * 1e8 / 6000 + of_waiting(1e8, 6'000) + kBytesPerRun, 1e6);
  request.mutable_size()->set_constant(16 * kOnLattice / 4e8);
  EXPECT_LT(static_cast<double>(expected_bytes(request, {})), 2.5 * streams);
  request.mutable_budget()->set_max_triangles(1'000'000'000);  // nothing is sent before the end
  EXPECT_EQ(expected_bytes(request, {}), Limits{}.max_bytes);
}

TEST(Estimate, GrowsWithTheEdgesThatLengthsAtMarkersAskFor) {
  v1::GenerateMeshRequest request;
  for (const double x : {0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0})
    request.mutable_domain()->add_points(x);
  for (const std::uint32_t i : {0u, 1u, 1u, 2u, 2u, 3u, 3u, 0u})
    request.mutable_domain()->add_segments(i);
  for (const std::int32_t marker : {1, 2, 3, 2})
    request.mutable_domain()->add_segment_markers(marker);
  request.mutable_quality()->set_min_angle_deg(35);
  request.mutable_size()->set_constant(1);
  v1::SizeAt& at = *request.mutable_size()->add_at();
  at.set_marker(3);
  at.set_max_edge(1e-6);  // so many edges on one side
  const auto estimate = [&] { return static_cast<double>(expected_bytes(request, {})); };
  EXPECT_NEAR(estimate(), of_whole(4e6), 0.1 * of_whole(4e6));
  at.set_marker(2);
  EXPECT_NEAR(estimate(), of_whole(8e6), 0.1 * of_whole(8e6));
  request.mutable_size()->set_gradation(0.5);
  EXPECT_NEAR(estimate(), of_whole(16e6), 0.1 * of_whole(16e6));
  at.set_marker(4);  // no segment has it, which the engine refuses
  EXPECT_LT(estimate(), 2e6);
  at.set_marker(3);
  at.set_max_edge(1e-300);
  EXPECT_EQ(expected_bytes(request, {}), Limits{}.max_bytes);
}

TEST(Estimate, LeavesOutHolesAndWhatIsOutsideAndCountsRegions) {
  const double square = 16 * kOnLattice / 1e-4;
  v1::GenerateMeshRequest request;
  for (const double x :
       {0.0, 0.0, 4.0, 0.0, 4.0, 4.0, 0.0, 4.0, 1.0, 1.0, 3.0, 1.0, 3.0, 3.0, 1.0, 3.0})
    request.mutable_domain()->add_points(x);
  for (const std::uint32_t i : {0u, 1u, 1u, 2u, 2u, 3u, 3u, 0u, 4u, 5u, 5u, 6u, 6u, 7u, 7u, 4u})
    request.mutable_domain()->add_segments(i);
  request.mutable_size()->set_constant(1e-4);
  const auto estimate = [&] {
    return static_cast<double>(expected_bytes(request, {})) - kBytesPerRun;
  };
  const auto expect_near = [&](double triangles, double tolerance) {
    EXPECT_NEAR(estimate(), of_whole(triangles), tolerance * of_whole(triangles));
  };
  expect_near(square, 0.02);
  v1::GenerateMeshRequest even_odd = request;
  request.mutable_domain()->add_holes(2);
  request.mutable_domain()->add_holes(2);
  expect_near(0.75 * square, 0.04);
  even_odd.mutable_domain()->set_fill(v1::FILL_EVEN_ODD);
  EXPECT_EQ(expected_bytes(even_odd, {}), expected_bytes(request, {}));
  request.mutable_domain()->clear_holes();
  v1::Region& region = *request.mutable_domain()->add_regions();
  region.set_x(2);
  region.set_y(2);
  region.set_max_area(2e-5);
  expect_near(2 * kIfItVaries * square, 0.05);
}

TEST(Estimate, OfAreasIsThatOfWhatTheyCoverByTheBoundThere) {
  v1::GenerateMeshRequest request;
  v1::Domain& domain = *request.mutable_domain();
  domain.set_fill(v1::FILL_UNION);
  const auto add_box = [&](double low, double high) -> v1::Area& {
    const auto first = static_cast<std::uint32_t>(domain.points_size() / 2);
    for (const double x : {low, low, high, low, high, high, low, high}) domain.add_points(x);
    v1::Area& area = *domain.add_areas();
    for (std::uint32_t i = 0; i < 4; ++i) {
      domain.add_segments(first + i);
      domain.add_segments(first + (i + 1) % 4);
      domain.add_segment_areas(static_cast<std::uint32_t>(domain.areas_size()));
    }
    return area;
  };
  add_box(0, 4);
  add_box(0, 4);  // once more
  add_box(1, 3);
  request.mutable_size()->set_constant(1e-4);
  const auto expect_near = [&](double triangles, double tolerance) {
    const double estimate = static_cast<double>(expected_bytes(request, {})) - kBytesPerRun;
    EXPECT_NEAR(estimate, of_whole(triangles), tolerance * of_whole(triangles));
  };
  const double square = 16 * kOnLattice * 1e4;
  expect_near(square, 0.02);
  domain.mutable_areas(2)->set_hole(true);
  expect_near(0.75 * square, 0.04);
  domain.mutable_areas(2)->set_hole(false);
  domain.set_fill(v1::FILL_EVEN_ODD);
  expect_near(0.25 * square, 0.2);  // so does the border of what is left out
  domain.set_fill(v1::FILL_UNION);
  domain.mutable_areas(2)->set_max_area(2.5e-5);
  expect_near((0.75 + 4 * 0.25) * kIfItVaries * square, 0.2);  // cells at the border count as finer
}

TEST(Estimate, OfAnExpressionIsThatOfItsMean) {
  EXPECT_EQ(estimate_of("1e-4"), estimate_of("x < 100 ? 1e-4 : 1"));
  // Half of the square asks for a hundred times as much as the other half.
  const std::uint64_t half = estimate_of("x < 2 ? 1e-5 : 1e-3") - estimate_of("1");
  EXPECT_NEAR(static_cast<double>(half), of_whole(0.505 * 16 * kOnLattice * kIfItVaries * 1e5),
              1.0 * kMegabyte);
}

TEST(Estimate, OfARasterIsThatOfTheMeanOfItsValuesAndTheirOwn) {
  v1::GenerateMeshRequest request = valid_request();
  v1::Raster& raster = *request.mutable_size()->mutable_raster();
  for (int i = 0; i < 1'000'000; ++i) raster.add_values(i < 500'000 ? 1e-5 : 1e-3);
  const std::uint64_t half = expected_bytes(request, {}) - estimate_of("1");
  EXPECT_NEAR(static_cast<double>(half), of_whole(0.505 * 16 * kOnLattice * 1e5) + 16e6,
              1.0 * kMegabyte);
}

TEST(Estimate, IsAtMostWhatTheJobMayTake) {
  v1::GenerateMeshRequest request = valid_request();
  request.mutable_size()->set_constant(1e-12);
  request.mutable_quality()->set_min_angle_deg(35);
  Limits limits;
  EXPECT_EQ(expected_bytes(request, limits), limits.max_bytes);
  request.mutable_budget()->set_max_bytes(30 * kMegabyte);
  EXPECT_EQ(expected_bytes(request, limits), 30 * kMegabyte);
  request.mutable_budget()->clear_max_bytes();
  request.mutable_budget()->set_max_triangles(1000);
  EXPECT_LT(expected_bytes(request, limits), 20 * kMegabyte);
}

TEST(Estimate, OfARequestThatMakesNoSenseIsFinite) {
  v1::GenerateMeshRequest request = valid_request();
  for (const char* expression : {"0", "-1", "1/0", "sqrt(-1)", "x +"})
    EXPECT_LE(estimate_of(expression), Limits{}.max_bytes) << expression;
  request.mutable_domain()->set_points(0, std::numeric_limits<double>::quiet_NaN());
  request.mutable_domain()->set_points(1, std::numeric_limits<double>::infinity());
  EXPECT_LE(expected_bytes(request, {}), Limits{}.max_bytes);
  EXPECT_LE(expected_bytes(v1::GenerateMeshRequest(), {}), Limits{}.max_bytes);
}

}  // namespace
}  // namespace weft::server::testing
