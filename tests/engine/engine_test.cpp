// SPDX-License-Identifier: Apache-2.0
// The engine's promises other than the mesh's quality: errors, budgets, stopping, determinism.
#include "weft/weft.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include "tests/engine/domain/shapes.h"
#include "tests/support/collected_mesh.h"
#include "tests/support/poly.h"
#include "tests/support/processor_time.h"

namespace weft {
namespace {

Result<Summary> mesh_of(const MeshRequest& request, const Budget& budget = {}) {
  CollectedMesh mesh;
  weft::Run run(budget);
  auto summary = stream(request, mesh, run);
  if (summary) {
    EXPECT_EQ(verdict(request, mesh, *summary), "");
  }
  return summary;
}

Error error_of(const MeshRequest& request, const Budget& budget = {}) {
  CollectedMesh mesh;
  weft::Run run(budget);
  const auto summary = stream(request, mesh, run);
  EXPECT_FALSE(summary);
  // What refinement meets may show only after chunks have left.
  if (!summary && summary.error().code != ErrorCode::kBudgetExceeded) {
    EXPECT_EQ(mesh.chunks, 0u);
  }
  return summary ? Error{} : summary.error();
}

TEST(Options, AboveTheLargestMinimumAngleAreRefusedWithTheLimit) {
  const Error error = error_of({.pslg = square(), .min_angle_deg = 61});
  EXPECT_EQ(error.code, ErrorCode::kBadOption);
  EXPECT_EQ(error.field, "quality.min_angle_deg");
  EXPECT_NE(error.message.find("61"), std::string::npos) << error.message;
  EXPECT_NE(error.message.find("36"), std::string::npos) << error.message;
}

TEST(Options, OfTooManySweepsAreRefusedWithTheLimit) {
  const Error error = error_of({.pslg = square(), .sweeps = 17});
  EXPECT_EQ(error.code, ErrorCode::kBadOption);
  EXPECT_EQ(error.field, "quality.optimise");
  EXPECT_NE(error.message.find("17"), std::string::npos) << error.message;
  EXPECT_NE(error.message.find("16"), std::string::npos) << error.message;
}

TEST(Options, OfANegativeShortestEdgeAreRefused) {
  EXPECT_EQ(error_of({.pslg = square(), .min_edge = -1}).field, "quality.min_edge");
}

TEST(Range, OfCoordinatesIsKeptAtBothEnds) {
  EXPECT_EQ(error_of({.pslg = square(1e60)}).code, ErrorCode::kBadCoordinate);
  EXPECT_EQ(error_of({.pslg = square(1e-60)}).code, ErrorCode::kBadCoordinate);
  EXPECT_TRUE(mesh_of({.pslg = square(1e49), .size = 1e95}));
  EXPECT_TRUE(mesh_of({.pslg = square(1e-39), .size = 1e-81}));
}

TEST(Size, OfZeroIsRefused) {
  const Error error = error_of({.pslg = square(), .size = 0.0});
  EXPECT_EQ(error.code, ErrorCode::kBadSizeValue);
  EXPECT_EQ(error.field, "size.constant");
}

TEST(Size, ThatIsAConstantExpressionBelowZeroIsRefused) {
  const Error error = error_of({.pslg = square(), .size = "1-2"});
  EXPECT_EQ(error.code, ErrorCode::kBadSizeValue);
  EXPECT_NE(error.message.find("-1"), std::string::npos) << error.message;
}

// The run reports what was reported before it.
void expect_same(const std::optional<Error>& judged, const MeshRequest& request) {
  ASSERT_TRUE(judged);
  const Error met = error_of(request);
  EXPECT_EQ(judged->code, met.code) << judged->message;
  EXPECT_EQ(judged->field, met.field);
  EXPECT_EQ(judged->message, met.message);
}

TEST(Options, AreJudgedAsTheRunJudgesThem) {
  for (const MeshRequest& request :
       {MeshRequest{.pslg = square(), .min_angle_deg = 61},
        MeshRequest{.pslg = square(), .min_edge = -1}, MeshRequest{.pslg = square(), .sweeps = 17}})
    expect_same(check_options(request), request);
  EXPECT_FALSE(check_options({.pslg = square(), .size = "1+x"}));
}

TEST(Size, IsJudgedAsTheRunJudgesIt) {
  SizeSpec steep = "1+x";
  steep.gradation = -1;
  SizeSpec nameless = "1+x";
  nameless.fields.push_back({"x", WidthSpec{}});
  for (const SizeSpec& size :
       {SizeSpec{-1.0}, SizeSpec{"1-2"}, SizeSpec{"1+"}, SizeSpec{"1+z"}, steep, nameless}) {
    const auto judged = check_size(size);
    ASSERT_TRUE(judged);
    expect_same(*judged, {.pslg = square(), .size = size});
  }
  EXPECT_FALSE(check_size("1+x"));
}

TEST(Domain, IsJudgedAsTheRunJudgesIt) {
  Pslg not_a_number = square();
  not_a_number.points[2].y = std::numeric_limits<double>::quiet_NaN();
  Pslg no_point = square();
  no_point.segments[1].b = 4;
  Pslg line;
  line.points = {{0, 0}, {1, 1}, {2, 2}};
  for (const Pslg& pslg : {not_a_number, no_point, line})
    expect_same(check_pslg(pslg), {.pslg = pslg});
  EXPECT_FALSE(check_pslg(square()));
}

// A square of side 10 around a triangle whose sides have the markers 1, 2, 3; two of them meet at
// 18 degrees. That with the marker 2 is a slope of length 2 sqrt(10).
MeshRequest with_sizes_at(std::vector<SizeAt> at) {
  MeshRequest request{.pslg = square(10)};
  const auto first = static_cast<std::uint32_t>(request.pslg.points.size());
  for (const Point p : {Point{2, 2}, Point{8, 2}, Point{2, 4}}) request.pslg.points.push_back(p);
  request.pslg.segments.push_back({first, first + 1, 1});
  request.pslg.segments.push_back({first + 1, first + 2, 2});
  request.pslg.segments.push_back({first + 2, first, 3});
  request.size.at = std::move(at);
  return request;
}

TEST(SizeAt, LimitsEdgesOnSegmentsWithItsMarkerAlone) {
  const MeshRequest request = with_sizes_at({{2, 0.1}});
  CollectedMesh mesh;
  weft::Run run;
  const auto summary = stream(request, mesh, run);
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_EQ(verdict(request, mesh, *summary), "");
  double sum = 0;
  std::size_t edges = 0;
  for (const check::Mesh::Edge& edge : mesh.mesh.edges) {
    if (edge.marker != 2) continue;
    const auto a = mesh.mesh.vertices[edge.a], b = mesh.mesh.vertices[edge.b];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    EXPECT_LE(length, 0.1 * (1 + 1e-9));
    sum += length;
    ++edges;
  }
  EXPECT_NEAR(sum, std::sqrt(40), 1e-9);
  EXPECT_LT(edges, 128u);  // 64 would do
  EXPECT_LT(summary->triangles, 1500u);
}

TEST(SizeAt, WithAGradationHoldsForTrianglesAround) {
  MeshRequest request = with_sizes_at({{2, 0.1}, {-4, 1}, {3, 0.02}});
  request.pslg.segments[0].marker = -4;
  request.size.gradation = 0.2;
  EXPECT_TRUE(mesh_of(request));
  request.size.value = "0.5 + 0.05*x";
  request.size.measure = Measure::kEdge;
  EXPECT_TRUE(mesh_of(request));
  request.placement = Placement::kCircumcentre;
  EXPECT_TRUE(mesh_of(request));
}

TEST(SizeAt, DividesASegmentIntoEqualParts) {
  MeshRequest request{.pslg = square(10), .min_angle_deg = 0};
  request.pslg.segments[0].marker = 1;
  for (const auto& [max_edge, count] : {std::pair{0.7, 15}, {0.5, 20}, {10.0 / 3, 3}, {10.0, 1}}) {
    request.size.at = {{1, max_edge}};
    CollectedMesh mesh;
    weft::Run run;
    ASSERT_TRUE(stream(request, mesh, run));
    EXPECT_EQ(std::count_if(mesh.mesh.edges.begin(), mesh.mesh.edges.end(),
                            [](const check::Mesh::Edge& edge) { return edge.marker == 1; }),
              count);
  }
}

TEST(SizeAt, BelowTwiceTheShortestEdgeIsRefused) {
  MeshRequest request = with_sizes_at({{1, 1}, {2, 0.1}});
  request.min_edge = 0.06;
  const Error error = error_of(request);
  EXPECT_EQ(error.code, ErrorCode::kBadOption);
  EXPECT_EQ(error.field, "size.at[1].max_edge");
  EXPECT_NE(error.message.find("0.1; it must be at least 0.12"), std::string::npos)
      << error.message;
  EXPECT_EQ(error_of(with_sizes_at({{1, 1e-15}})).field, "size.at[0].max_edge");
}

TEST(SizeAt, ThatAsksForTooManyEdgesIsRefusedBeforeTheWork) {
  const Error error = error_of(with_sizes_at({{2, 1e-6}}), {.triangle_limit = 6'000'000});
  EXPECT_EQ(error.code, ErrorCode::kLimitExceeded);
  EXPECT_EQ(error.field, "size.at");
  EXPECT_NE(error.message.find("at least 6324"), std::string::npos) << error.message;
}

TEST(SizeAt, WhoseEdgesTakeMoreThanTheBudgetIsRefusedBeforeTheWork) {
  const Error error = error_of(with_sizes_at({{2, 1e-6}}), {.max_bytes = 300'000'000});
  EXPECT_EQ(error.code, ErrorCode::kBudgetExceeded);
  EXPECT_EQ(error.field, "size.at");
  EXPECT_NE(error.message.find("6324556 edges, which take 328876"), std::string::npos)
      << error.message;
  EXPECT_NE(error.message.find("300000000"), std::string::npos) << error.message;
}

TEST(Size, ThatDividesByZeroNamesThePoint) {
  const Error error = error_of({.pslg = square(), .size = "1/(x-x)"});
  EXPECT_EQ(error.code, ErrorCode::kBadSizeValue);
  EXPECT_NE(error.message.find("the size at ("), std::string::npos) << error.message;
}

TEST(Size, ThatIsNegativeInAPartOfTheDomainIsFoundThere) {
  const Error error = error_of({.pslg = square(10), .size = "(x-9)^2+(y-9)^2 < 0.01 ? -1 : 1"});
  EXPECT_EQ(error.code, ErrorCode::kBadSizeValue);
}

TEST(Size, ThatIsInfiniteInAPartOfTheDomainNamesThePoint) {
  MeshRequest request{.pslg = square()};
  add_box(request.pslg, {8, 0}, {9, 1});  // no triangle straddles the step
  request.size = "x > 5 ? 1/0 : 0.01";
  const Error error = error_of(request);
  EXPECT_EQ(error.code, ErrorCode::kBadSizeValue);
  EXPECT_NE(error.message.find("is inf"), std::string::npos) << error.message;
  ASSERT_TRUE(error.at);
  EXPECT_GT(error.at->x, 5);
}

TEST(Size, ThatNeedsATrillionTrianglesIsRefusedByEstimate) {
  const Error error = error_of({.pslg = square(), .size = 1e-12}, {.triangle_limit = 1'000'000});
  EXPECT_EQ(error.code, ErrorCode::kLimitExceeded);
  EXPECT_EQ(error.field, "size");
  EXPECT_NE(error.message.find("1000000"), std::string::npos) << error.message;
  const Error graded =
      error_of({.pslg = square(), .size = "1e-12*(1+x)"}, {.triangle_limit = 1'000'000});
  EXPECT_EQ(graded.code, ErrorCode::kLimitExceeded);
}

TEST(Size, OfARegionThatNeedsATrillionTrianglesIsRefusedByEstimate) {
  MeshRequest request{.pslg = square()};
  request.pslg.regions.push_back({{0.5, 0.5}, 1, 1e-12});
  EXPECT_EQ(error_of(request, {.triangle_limit = 1'000'000}).code, ErrorCode::kLimitExceeded);
}

// Edges of a share of the distance to the border.
MeshRequest request_by_distance(const std::string& size) {
  MeshRequest request{.pslg = square()};
  request.size = size;
  request.size.fields.push_back({"d", DistanceSpec{}});
  return request;
}

TEST(Size, ThatVanishesOnASegmentIsRefused) {
  const Error error = error_of(request_by_distance("0.4*d^2"), {.triangle_limit = 10'000});
  EXPECT_EQ(error.code, ErrorCode::kBadSizeValue);
  EXPECT_EQ(error.field, "size");
  EXPECT_NE(error.message.find("on the segment through (0.5, 0)"), std::string::npos)
      << error.message;
  EXPECT_EQ(error.at, (Point{0.5, 0}));
}

TEST(Size, ThatVanishesOnASegmentMoreSlowlyOrWithALeastValueIsMet) {
  for (const char* size : {"d", "d^1.2", "max(0.4*d^2, 1e-4)", "max(d - 0.1, 1e-3)"})
    EXPECT_TRUE(mesh_of(request_by_distance(size))) << size;
}

TEST(Size, ThatVanishesOnASegmentIsMetDownToTheLeastEdgeOrUpToTheMostTriangles) {
  MeshRequest request = request_by_distance("0.4*d^2");
  EXPECT_TRUE(mesh_of(request, {.max_triangles = 100}));
  request.min_edge = 0.05;
  EXPECT_TRUE(mesh_of(request));
}

TEST(Size, ThatIsNowherePositiveIsABadSizeAndNoLimit) {
  const Error error = error_of({.pslg = square(), .size = "log(x)"}, {.triangle_limit = 1'000'000});
  EXPECT_EQ(error.code, ErrorCode::kBadSizeValue) << error.message;
}

TEST(Size, WithASpotFinerThanOneHugeTriangleIsFollowed) {
  // The box has two triangles; no centroid of theirs is near the disc.
  MeshRequest request;
  add_box(request.pslg, {0, 0}, {65, 40});
  request.size = "(x-50)^2+(y-11)^2 < 1 ? 1e-3 : 1e6";
  const auto summary = mesh_of(request);
  ASSERT_TRUE(summary);
  // The disc alone needs pi / 1e-3 triangles.
  EXPECT_GT(summary->triangles, 3141u);
}

// Over the box [0, 65] x [0, 40]: 1, but finer towards the nodes around (50, 11).
Raster raster_with_a_spot() {
  Raster raster{{0, 0}, 1, 1, 66, 41, std::vector<double>(66 * 41, 1)};
  for (const std::size_t j : {11, 12})
    for (const std::size_t i : {50, 51}) raster.values[j * 66 + i] = 1e-3;
  return raster;
}

TEST(Size, OfARasterIsKeptAndFollowed) {
  MeshRequest request;
  add_box(request.pslg, {0, 0}, {65, 40});
  request.size = raster_with_a_spot();
  const auto summary = mesh_of(request);
  ASSERT_TRUE(summary);
  // The spot alone is a square of area 1.
  EXPECT_GT(summary->triangles, 1'000u + 2'600u);
  EXPECT_LT(summary->triangles, 15'000u);
}

TEST(Size, OfARasterThatEndsInsideTheDomainGoesOnAsItEnds) {
  MeshRequest request;
  add_box(request.pslg, {-10, -10}, {10, 10});
  request.size = Raster{{0, 0}, 1, 1, 2, 1, {0.01, 1}};
  const auto summary = mesh_of(request);
  ASSERT_TRUE(summary);
  EXPECT_GT(summary->triangles, 20'000u);  // the left half
}

TEST(Size, OfARasterWithAValueThatIsNoneNamesIt) {
  MeshRequest request{.pslg = square()};
  request.size = raster_with_a_spot();
  std::get<Raster>(request.size.value).values[17] = 0;
  const Error error = error_of(request);
  EXPECT_EQ(error.code, ErrorCode::kBadSizeValue);
  EXPECT_EQ(error.field, "size.raster.values[17]");
}

TEST(Size, ThatReachesZeroInAHoleDoesNoHarm) {
  MeshRequest request;
  add_box(request.pslg, {-4, -4}, {4, 4});
  add_box(request.pslg, {-1, -1}, {1, 1});
  request.pslg.holes.push_back({0, 0});
  request.size = "0.1*(x^2+y^2)^2";
  const auto summary = mesh_of(request);
  ASSERT_TRUE(summary);
  EXPECT_LT(summary->triangles, 2'000u);
}

TEST(Size, OfRegionsIsKeptBesideTheField) {
  MeshRequest request;
  add_box(request.pslg, {0, 0}, {2, 1});
  add_segment(request.pslg, {1, 0}, {1, 1}, 7);
  request.pslg.regions = {{{0.5, 0.5}, 3, 0.001}, {{1.5, 0.5}, 4, {}}};
  request.size = 0.01;
  const auto summary = mesh_of(request);
  ASSERT_TRUE(summary);
  EXPECT_GT(summary->triangles, 1'000u + 100u);
}

TEST(Budget, OfTrianglesGivesTheMeshThatThereIs) {
  const auto summary = mesh_of({.pslg = square(), .size = 1e-12}, {.max_triangles = 1000});
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_LE(summary->triangles, 1000u);
  EXPECT_GT(summary->triangles, 900u);
  EXPECT_GT(summary->unrefined.budget, 0u);
}

TEST(Budget, ThatAMeshFitsExactlyIsNoError) {
  // The square has two triangles and needs no more.
  EXPECT_TRUE(mesh_of({.pslg = square()}, {.triangle_limit = 2}));
  const auto summary = mesh_of({.pslg = square(), .size = 0.01});
  ASSERT_TRUE(summary);
  EXPECT_TRUE(
      mesh_of({.pslg = square(), .size = 0.01}, {.triangle_limit = summary->triangles + 1}));
}

TEST(Budget, OfTrianglesMayBeTheLimitItself) {
  const auto summary =
      mesh_of({.pslg = square(), .size = 0.01}, {.max_triangles = 100, .triangle_limit = 100});
  ASSERT_TRUE(summary);
  EXPECT_GT(summary->unrefined.budget, 0u);
}

TEST(Budget, OfTrianglesThatIsNotReachedChangesNothing) {
  const MeshRequest request{.pslg = square(), .size = 1e-4, .leaf_triangles = 500};
  const auto uncapped = mesh_of(request);
  ASSERT_TRUE(uncapped);
  const auto capped = mesh_of(request, {.max_triangles = uncapped->triangles});
  ASSERT_TRUE(capped);
  EXPECT_EQ(capped->digest, uncapped->digest);
  const auto cut_off = mesh_of(request, {.max_triangles = uncapped->triangles - 1});
  ASSERT_TRUE(cut_off);
  EXPECT_LT(cut_off->triangles, uncapped->triangles);
}

TEST(Budget, OfTheShortestEdgeFarAboveTheSizeMakesASmallMesh) {
  const MeshRequest request{.pslg = square(), .size = 5e-9, .min_edge = 0.01};
  const auto summary = mesh_of(request);
  ASSERT_TRUE(summary);
  EXPECT_LT(summary->triangles, 40'000u);
  EXPECT_LT(summary->leaves.size(), 64u);
  EXPECT_GT(summary->unrefined.edge_floor, 0u);
}

TEST(Budget, OfNumbersEndsAMeshThatCannotStream) {
  MeshRequest request{.pslg = square(), .size = 5e-10, .min_angle_deg = 31};
  const Error error = error_of(request, {});
  EXPECT_EQ(error.code, ErrorCode::kLimitExceeded);
  EXPECT_EQ(error.field, "size");
  EXPECT_NE(error.message.find("at most 1073741823"), std::string::npos) << error.message;
}

TEST(Budget, OfBytesIsNamedWhenItRunsOut) {
  const Error error = error_of({.pslg = square(), .size = 1e-6}, {.max_bytes = 4 << 20});
  EXPECT_EQ(error.code, ErrorCode::kBudgetExceeded);
  EXPECT_NE(error.message.find("4194304"), std::string::npos) << error.message;
}

TEST(Budget, OfTheShortestEdgeIsKeptAndCounted) {
  MeshRequest request{.pslg = square(), .size = 1e-4, .min_edge = 0.1};
  CollectedMesh mesh;
  weft::Run run;
  const auto summary = stream(request, mesh, run);
  ASSERT_TRUE(summary);
  EXPECT_EQ(verdict(request, mesh, *summary), "");
  EXPECT_GT(summary->unrefined.edge_floor, 0u);
  for (const auto& t : mesh.mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const check::Vec2 a = mesh.mesh.vertices[t[i]];
      const check::Vec2 b = mesh.mesh.vertices[t[(i + 1) % 3]];
      EXPECT_GE((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y), 0.1 * 0.1);
    }
  }
}

TEST(Stopping, ByTheDeadlineEndsTheJobWithinFiftyMilliseconds) {
  CollectedMesh mesh;
  weft::Run run;
  const double start = processor_seconds();
  run.set_deadline(weft::Run::Clock::now() + std::chrono::milliseconds(30));
  const auto summary = stream({.pslg = square(), .size = 1e-8}, mesh, run);
  const double seconds = processor_seconds() - start;
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().code, ErrorCode::kDeadlineExceeded);
  EXPECT_LT(seconds, 0.03 + 0.5 * slowdown());
}

TEST(Stopping, ByCancellationWinsOverTheDeadline) {
  CollectedMesh mesh;
  weft::Run run;
  run.set_deadline(weft::Run::Clock::now());
  run.cancel();
  const auto summary = stream({.pslg = square()}, mesh, run);
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().code, ErrorCode::kCancelled);
}

TEST(Stopping, FromAnotherThreadReachesEachStage) {
  for (const Stage stage : {Stage::kTriangulate, Stage::kRefine}) {
    CollectedMesh mesh;
    weft::Run run;
    std::thread canceller([&] {
      while (run.progress().stage < stage) std::this_thread::yield();
      run.cancel();
    });
    const auto summary = stream({.pslg = square(), .size = 1e-8}, mesh, run);
    canceller.join();
    ASSERT_FALSE(summary);
    EXPECT_EQ(summary.error().code, ErrorCode::kCancelled);
  }
}

TEST(Stopping, ByTheSinkEndsTheJob) {
  struct Refuses : ChunkSink {
    bool accept(Chunk&&) override { return false; }
  } sink;
  weft::Run run;
  const auto summary = stream({.pslg = square()}, sink, run);
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().code, ErrorCode::kCancelled);
}

TEST(MeshDeterminism, GivesTheSameDigestOnEveryRun) {
  const MeshRequest request{.pslg = read_poly(model("us-east-coast.poly")),
                            .size = "1e-3*(1.5+sin(x)*cos(y))"};
  const auto first = mesh_of(request);
  const auto second = mesh_of(request);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->digest, second->digest);
}

TEST(MeshDeterminism, GivesTheRecordedDigestOnEveryMachineAndCompiler) {
  MeshRequest request{.pslg = read_poly(model("pipe.poly")),
                      .size = "0.4*sqrt((x-200)^2+(y-200)^2)+1+sin(x)^2*exp(-y)"};
  const auto summary = mesh_of(request);
  ASSERT_TRUE(summary);
  std::string hex;
  for (unsigned byte : summary->digest) {
    constexpr char kDigits[] = "0123456789abcdef";
    hex += {kDigits[byte >> 4], kDigits[byte & 15]};
  }
  EXPECT_EQ(hex, "16767f321c78ced6a1d0cce1a035d3da3d2d474472a90e0042ef821d80e20d57");
}

TEST(Memory, AtThePeakIsAtMost48BytesATriangle) {
  const auto summary = mesh_of({.pslg = square(), .size = 1e-6});
  ASSERT_TRUE(summary);
  EXPECT_LE(static_cast<double>(summary->peak_bytes) / static_cast<double>(summary->triangles), 48);
}

}  // namespace
}  // namespace weft
