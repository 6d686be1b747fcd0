// SPDX-License-Identifier: Apache-2.0
// Features that are almost nothing apart, as rounding leaves them: either they merge, or they are
// meshed within the bounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "engine/engine.h"
#include "tests/engine/domain/shapes.h"
#include "tests/support/collected_mesh.h"
#include "tests/support/floor_plan.h"

namespace weft {
namespace {

// Meshes, and holds the mesh to the checker: all triangles are within their bounds, and there is no
// input angle to excuse one.
Summary within_bounds(const MeshRequest& request) {
  CollectedMesh collected;
  ExecutionContext context;
  const auto summary = generate_mesh(request, collected, context);
  if (!summary) {
    ADD_FAILURE() << summary.error().message;
    return {};
  }
  EXPECT_EQ(verdict(request, collected, *summary), "");
  EXPECT_EQ(summary->unrefined.total(), 0u);
  return *summary;
}

double rounded(double value, int decimals) {
  char text[64];
  const auto end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, decimals).ptr;
  double result = 0;
  std::from_chars(text, end, result);
  return result;
}

// Of all decimals and offsets.
template <class Check>
void for_plans(int count, Check&& check) {
  constexpr double kOffsets[] = {0, 1e5, 1e6};
  for (int i = 0; i < count; ++i) {
    const FloorPlan plan{static_cast<std::uint64_t>(i), kOffsets[i % 3], 2 + i / 3 % 8};
    SCOPED_TRACE(testing::Message() << "plan " << i << ", offset " << plan.offset << ", "
                                    << plan.decimals << " decimals");
    check(plan);
  }
}

TEST(FloorPlans, AreMeshedWithinTheirBounds) {
  for_plans(500, [](const FloorPlan& plan) {
    within_bounds({.pslg = floor_plan(plan)});
    within_bounds({.pslg = floor_plan(plan), .size = 1.0});
  });
}

TEST(FloorPlans, AreMeshedWithinSteepBounds) {
  for_plans(100, [](const FloorPlan& plan) {
    for (const double angle : {30.0, 33.0, 36.0}) {
      SCOPED_TRACE(angle);
      within_bounds({.pslg = floor_plan(plan), .min_angle_deg = angle});
    }
  });
}

TEST(FloorPlans, OfWhichTheErrorsAreMergedTakeNoMoreTrianglesThanUnrounded) {
  for_plans(500, [](const FloorPlan& plan) {
    FloorPlan exact = plan;
    exact.decimals = kUnrounded;
    MeshRequest request{.pslg = floor_plan(plan)};
    request.pslg.snap = 1.5 * std::pow(10, -plan.decimals);
    const Summary mesh = within_bounds(request);
    const Summary reference = within_bounds({.pslg = floor_plan(exact)});
    EXPECT_LE(static_cast<double>(mesh.triangles), 1.1 * static_cast<double>(reference.triangles));
    const Merging& merging = mesh.merging;
    EXPECT_GE(merging.tolerance, request.pslg.snap);
    EXPECT_LE(merging.farthest, merging.tolerance);
  });
}

// Without merging the errors. Where a partition ends a rounding error beside its wall, triangles
// begin as small as that error; with a size they are few beside the others. Triangle's worst plan
// takes 1.80 times as many (bench/README.md).
TEST(FloorPlans, TakeAFewMoreTrianglesThanUnroundedIfASizeIsAsked) {
  std::vector<double> ratios;
  double sum = 0, reference_sum = 0;
  for_plans(500, [&](const FloorPlan& plan) {
    FloorPlan exact = plan;
    exact.decimals = kUnrounded;
    const auto triangles = [](const FloorPlan& drawn) {
      CollectedMesh collected;
      ExecutionContext context;
      const auto summary =
          generate_mesh({.pslg = floor_plan(drawn), .size = 0.05}, collected, context);
      return summary ? static_cast<double>(summary->triangles) : std::nan("");
    };
    const double mesh = triangles(plan), reference = triangles(exact);
    EXPECT_LE(mesh, 1.9 * reference);
    ratios.push_back(mesh / reference);
    sum += mesh;
    reference_sum += reference;
  });
  std::nth_element(ratios.begin(), ratios.begin() + 250, ratios.end());
  EXPECT_LE(ratios[250], 1.04);
  EXPECT_LE(sum, 1.1 * reference_sum);
}

TEST(NearFeatures, OfAPartitionThatEndsOnAWallInUtmCoordinates) {
  for (int decimals = 2; decimals <= 12; ++decimals) {
    SCOPED_TRACE(decimals);
    MeshRequest request{.size = 10.0};
    const double end = rounded(4649846 + 140.0 / 3, decimals);
    add_box(request.pslg, {499900, 4649800}, {500400, 4650000});
    add_segment(request.pslg, {500000, 4649846}, {500300, 4649946});
    add_segment(request.pslg, {500140, end}, {500140, 4649976});
    within_bounds(request);
  }
}

TEST(NearFeatures, OfAPointAboveTheToleranceBesideASegment) {
  MeshRequest request{.size = 1e-3};
  add_box(request.pslg, {1, 1}, {1.9, 1.9});
  add_segment(request.pslg, {1.05, 1.1}, {1.85, 1.37});
  request.pslg.points.push_back({1.4, 1.2181250000000112});
  within_bounds(request);
}

TEST(NearFeatures, AtEveryDistanceAreMeshedWithinTheirBounds) {
  for (const double offset : {0.0, 1e3, 1e6}) {
    for (double distance = 1e-15; distance < 1e-2; distance *= 1.7) {
      SCOPED_TRACE(testing::Message() << distance << " at " << offset);
      MeshRequest request;
      add_box(request.pslg, {offset, offset}, {offset + 1, offset + 1});
      add_segment(request.pslg, {offset + 0.1, offset + 0.2}, {offset + 0.9, offset + 0.5});
      request.pslg.points.push_back({offset + 0.5, offset + 0.35 + distance * (offset + 1)});
      within_bounds(request);
    }
  }
}

}  // namespace
}  // namespace weft
