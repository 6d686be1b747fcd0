// SPDX-License-Identifier: Apache-2.0
// The functions of the library's face but for `stream`, which engine_test.cpp tests, and
// `estimate`.
#include "weft/weft.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "tests/engine/domain/shapes.h"
#include "tests/support/collected_mesh.h"

namespace weft {
namespace {

// Two squares side by side, of which only the one to the right has a region.
MeshRequest two_squares(double size) {
  MeshRequest request{.size = size};
  request.pslg.points = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {0, 1}};
  request.pslg.segments = {{0, 1, 1}, {1, 2, 1}, {2, 3, 2}, {3, 4, 3},
                           {4, 5, 3}, {5, 0, 4}, {1, 4}};
  request.pslg.regions = {{.at = {1.5, 0.5}, .id = 7}};
  return request;
}

// Judges the mesh that `stream` makes, and expects `mesh` to be the same.
void expect_same_as_its_chunks(const MeshRequest& request, const Mesh& mesh) {
  CollectedMesh collected;
  weft::Run run;
  const auto summary = stream(request, collected, run);
  ASSERT_TRUE(summary) << summary.error().message;
  ASSERT_EQ(verdict(request, collected, *summary), "");
  EXPECT_EQ(mesh.summary.digest, summary->digest);
  const check::Mesh& judged = collected.mesh;
  EXPECT_EQ(mesh.triangles, judged.triangles);
  EXPECT_EQ(mesh.input_points, judged.input_points);
  ASSERT_EQ(mesh.vertices.size(), judged.vertices.size());
  for (std::size_t i = 0; i < judged.vertices.size(); ++i)
    ASSERT_EQ(mesh.vertices[i], (Point{judged.vertices[i].x, judged.vertices[i].y})) << i;
  ASSERT_EQ(mesh.edges.size(), judged.edges.size());
  for (std::size_t i = 0; i < judged.edges.size(); ++i) {
    ASSERT_EQ(mesh.edges[i].a, judged.edges[i].a);
    ASSERT_EQ(mesh.edges[i].b, judged.edges[i].b);
    ASSERT_EQ(mesh.edges[i].marker, judged.edges[i].marker);
    ASSERT_LT(mesh.edges[i].segment, request.pslg.segments.size());
  }
  if (!mesh.regions.empty()) {
    EXPECT_EQ(mesh.regions, judged.regions);
  }
}

TEST(WholeMesh, IsItsChunksPutTogether) {
  const MeshRequest request = two_squares(4e-6);
  const auto made = mesh(request);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_GT(made->summary.chunks, 4u) << "of which some have no region";
  EXPECT_EQ(made->regions.size(), made->triangles.size());
  expect_same_as_its_chunks(request, *made);
}

TEST(WholeMesh, HasNoRegionsIfEveryIdIsZero) {
  MeshRequest request = two_squares(0.01);
  request.pslg.regions.clear();
  const auto made = mesh(request);
  ASSERT_TRUE(made);
  EXPECT_TRUE(made->regions.empty());
  expect_same_as_its_chunks(request, *made);
}

TEST(WholeMesh, IsTheSameOnAnyNumberOfThreads) {
  const MeshRequest request = two_squares(1e-5);
  const auto alone = mesh(request);
  ASSERT_TRUE(alone);
  for (const int threads : {1, 3}) {
    ThreadPool pool(threads);
    EXPECT_EQ(pool.threads(), threads);
    weft::Run run;
    run.set_threads(pool);
    const auto made = mesh(request, run);
    ASSERT_TRUE(made);
    EXPECT_EQ(made->summary.digest, alone->summary.digest);
    EXPECT_EQ(made->triangles, alone->triangles);
    EXPECT_EQ(run.progress().triangles, made->triangles.size());
    EXPECT_NEAR(run.progress().fraction, 1, 1e-9);
  }
}

TEST(WholeMesh, IsNoneIfTheRunEnds) {
  weft::Run cancelled;
  cancelled.cancel();
  EXPECT_TRUE(cancelled.poll());
  EXPECT_EQ(mesh(two_squares(0.01), cancelled).error().code, ErrorCode::kCancelled);
  weft::Run late;
  late.set_deadline(weft::Run::Clock::now());
  EXPECT_EQ(mesh(two_squares(0.01), late).error().code, ErrorCode::kDeadlineExceeded);
  weft::Run poor(Budget{.max_bytes = 1000});
  EXPECT_EQ(mesh(two_squares(0.01), poor).error().code, ErrorCode::kBudgetExceeded);
  EXPECT_EQ(mesh({}).error().code, ErrorCode::kTooFewPoints);
}

TEST(SizeRequest, IsToldInsteadOfAMesh) {
  MeshRequest request = two_squares(0.001);
  const auto made = mesh(request);
  ASSERT_TRUE(made);
  request.sample_points = {{0.5, 0.5}, {3, 0}};
  const auto told = mesh(request);
  ASSERT_TRUE(told) << told.error().message;
  const Summary& summary = told->summary;
  EXPECT_TRUE(told->triangles.empty());
  EXPECT_EQ(summary.chunks, 0u);
  ASSERT_EQ(summary.sampled_bounds.size(), 2u);
  EXPECT_EQ(summary.sampled_bounds[0], 0.001);
  EXPECT_TRUE(std::isnan(summary.sampled_bounds[1]));
  EXPECT_NEAR(summary.expected_triangles, static_cast<double>(made->triangles.size()),
              0.1 * static_cast<double>(made->triangles.size()));
  EXPECT_LT(estimate(request).bytes, estimate(two_squares(1e-6)).bytes / 4);
}

TEST(SizeRequest, IsRefusedWhereItIsNone) {
  MeshRequest request = two_squares(1);
  request.size = SizeSpec("x - 1");
  request.sample_points = {{1.5, 0.5}, {0.5, 0.25}};
  const auto told = mesh(request);
  ASSERT_FALSE(told);
  EXPECT_EQ(told.error().code, ErrorCode::kBadSizeValue);
  EXPECT_EQ(told.error().at, (Point{0.5, 0.25}));
}

TEST(SizeRequest, IsThatOfAMeshWhoseSizeIsNoneAtAPlace) {
  MeshRequest request = two_squares(1);
  request.size = SizeSpec("0.01 * hypot(x-0.5, y-0.5)");
  const auto made = mesh(request);
  ASSERT_TRUE(made) << made.error().message;
  request.sample_points = {{0.5, 0.5}, {1.5, 0.5}};
  const auto told = mesh(request);
  ASSERT_TRUE(told) << told.error().message;
  EXPECT_EQ(told->summary.sampled_bounds, (std::vector<double>{0, 0.01}));
  const double expected = told->summary.expected_triangles;
  EXPECT_GT(expected, 0.5 * static_cast<double>(made->triangles.size()));
  EXPECT_LT(expected, 1.2 * static_cast<double>(made->triangles.size()));
}

TEST(SizeRequest, IsThatOfFewFinitePoints) {
  MeshRequest request = two_squares(1);
  request.sample_points = {{0, 0}, {1, NAN}};
  ASSERT_TRUE(validate(request));
  EXPECT_EQ(validate(request)->field, "sample_points[1]");
  request.sample_points.assign(kMaxSamplePoints + 1, {0, 0});
  ASSERT_TRUE(validate(request));
  EXPECT_EQ(validate(request)->field, "sample_points");
}

TEST(ValidRequest, HasNothingThatIsRefusedBeforeWork) {
  EXPECT_FALSE(validate(two_squares(0.01)));
  const auto field_of = [](const MeshRequest& request) {
    const auto error = validate(request);
    EXPECT_TRUE(error);
    EXPECT_EQ(mesh(request).error().field, error ? error->field : "");
    return error ? error->field : "";
  };
  MeshRequest request = two_squares(0.01);
  request.pslg.segments[3].b = 99;
  EXPECT_EQ(field_of(request), "domain.segments[3].b");
  request = two_squares(0.01);
  request.size = Raster{{0, 0}, 1, 1, 2, 2, {1, 2, 0, 1}};
  EXPECT_EQ(field_of(request), "size.raster.values[2]");
  request.size = "x +";
  EXPECT_EQ(field_of(request), "size.expression");
  request.min_angle_deg = kMaxMinAngleDeg + 1;
  EXPECT_EQ(field_of(request), "quality.min_angle_deg");
}

}  // namespace
}  // namespace weft
