// SPDX-License-Identifier: Apache-2.0
// Segments that meet at such small angles that rounding could turn them over each other.
#include <gtest/gtest.h>

#include "tests/engine/domain/shapes.h"
#include "tests/support/collected_mesh.h"
#include "weft/weft.h"

namespace weft {
namespace {

// Meshes, and holds the mesh to the checker, whether or not all of it could be refined.
Summary sound(MeshRequest request) {
  request.allow_unrefined = true;
  CollectedMesh collected;
  weft::Run run;
  const auto summary = stream(request, collected, run);
  if (!summary) {
    ADD_FAILURE() << summary.error().message;
    return {};
  }
  EXPECT_EQ(verdict(request, collected, *summary), "");
  return *summary;
}

// A box around a needle from (1, 1) to (2, 1 -+ width / 2), and a point beside its tip, so that the
// needle's sides are split down to where they are less apart than doubles.
MeshRequest needle(double width, double beside) {
  MeshRequest request{.min_angle_deg = 20};
  add_box(request.pslg, {0, 0}, {3, 2});
  add_segment(request.pslg, {1, 1}, {2, 1 - width / 2});
  add_segment(request.pslg, {1, 1}, {2, 1 + width / 2});
  add_segment(request.pslg, {2, 1 - width / 2}, {2, 1 + width / 2});
  request.pslg.points.push_back({1 - beside, 1 + beside});
  return request;
}

TEST(Needles, ThatAreMeshedStayDelaunay) {
  for (const double width : {1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6})
    for (const double beside : {4e-12, 1e-10, 1e-8, 1e-6}) {
      SCOPED_TRACE(testing::Message() << width << ", " << beside);
      sound(needle(width, beside));
    }
}

TEST(Needles, ThatAreHolesKeepTheirSidesApart) {
  for (const double width : {1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6})
    for (const double beside : {4e-12, 1e-10, 1e-8, 1e-6}) {
      SCOPED_TRACE(testing::Message() << width << ", " << beside);
      MeshRequest request = needle(width, beside);
      request.pslg.holes = {{1.9, 1}};
      sound(request);
    }
}

// The same with several needles at one corner.
TEST(Needles, InAFanOfHolesKeepTheirSidesApart) {
  MeshRequest request = needle(1e-9, 1e-9);
  add_segment(request.pslg, {1, 1}, {1.5, 1 + 2e-9});
  add_segment(request.pslg, {2, 1 + 0.5e-9}, {1.5, 1 + 2e-9});
  request.pslg.holes = {{1.9, 1}, {1.5, 1 + 1e-9}};
  sound(request);
}

// The piece that is not split has triangles on one side alone, and its far end is what is too near.
TEST(Needles, RefusedForTheShortestEdgeAreExemptByIt) {
  MeshRequest request{.min_angle_deg = 25, .min_edge = 261.90476190476193};
  request.pslg.points = {{4800, 3600},     {-1000, 8000},          {4203.4, 4398.8},
                         {4202.8, 4404.6}, {4212.0625, 4400.0625}, {0, 0}};
  request.pslg.segments = {{0, 1, 0}, {1, 2, 1}, {2, 3, 2}, {3, 4, 3}, {3, 5, 4}, {4, 5, 0}};
  const Summary summary = sound(request);
  EXPECT_GT(summary.unrefined.edge_floor, 0u);
  EXPECT_EQ(summary.unrefined.precision, 0u);
}

}  // namespace
}  // namespace weft
