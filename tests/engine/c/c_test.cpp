// SPDX-License-Identifier: Apache-2.0
// The C interface gives the mesh that the library for C++ makes of the same request.
#include "weft/c.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <string>

#include "engine/c/error_names.h"
#include "tests/engine/domain/shapes.h"
#include "tests/support/collected_mesh.h"
#include "weft/weft.h"

namespace weft {
namespace {

// The square of `square()`, with a hole and a region.
struct Given {
  std::vector<double> points{0, 0, 4, 0, 4, 4, 0, 4, 1, 1, 2, 1, 2, 2, 1, 2};
  std::vector<std::uint32_t> segments{0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 5, 6, 6, 7, 7, 4};
  std::vector<std::int32_t> markers{1, 1, 2, 2, 3, 3, 3, 3};
  std::vector<double> holes{1.5, 1.5};
  weft_region region{3, 3, 7, {0, 1, 0, 0.3}};
  weft_request request = WEFT_REQUEST;
  MeshRequest same;

  Given() {
    request.points = points.data();
    request.point_count = points.size() / 2;
    request.segments = segments.data();
    request.segment_count = markers.size();
    request.segment_markers = markers.data();
    request.holes = holes.data();
    request.hole_count = 1;
    request.regions = &region;
    request.region_count = 1;
    for (std::size_t i = 0; i < points.size(); i += 2)
      same.pslg.points.push_back({points[i], points[i + 1]});
    for (std::size_t i = 0; i < markers.size(); ++i)
      same.pslg.segments.push_back({segments[2 * i], segments[2 * i + 1], markers[i]});
    same.pslg.holes = {{1.5, 1.5}};
    same.pslg.regions = {{.at = {3, 3}, .id = 7, .max_area = area_of_edge(0.3)}};
  }

  // Makes both, has the checker judge the one, and compares the other.
  void expect_same() {
    CollectedMesh judged;
    weft::Run run;
    const auto summary = stream(same, judged, run);
    ASSERT_TRUE(summary) << summary.error().message;
    EXPECT_EQ(verdict(same, judged, *summary), "");
    weft_error* error = nullptr;
    weft_mesh* const made = weft_make(&request, nullptr, &error);
    ASSERT_TRUE(made) << weft_error_message(error);
    weft_summary told WEFT_SUMMARY;
    weft_mesh_summary(made, &told);
    EXPECT_TRUE(std::equal(summary->digest.begin(), summary->digest.end(), told.digest));
    weft_arrays arrays WEFT_ARRAYS;
    weft_mesh_arrays(made, &arrays);
    ASSERT_EQ(arrays.vertex_count, judged.mesh.vertices.size());
    ASSERT_EQ(arrays.triangle_count, judged.mesh.triangles.size());
    for (std::size_t i = 0; i < arrays.vertex_count; ++i)
      ASSERT_EQ(arrays.vertices[2 * i + 1], judged.mesh.vertices[i].y);
    for (std::size_t i = 0; i < arrays.triangle_count; ++i) {
      ASSERT_EQ(arrays.triangles[3 * i + 2], judged.mesh.triangles[i][2]);
      ASSERT_EQ(arrays.regions == nullptr ? 0 : arrays.regions[i], judged.mesh.regions[i]);
    }
    ASSERT_EQ(arrays.edge_count, judged.mesh.edges.size());
    for (std::size_t i = 0; i < arrays.edge_count; ++i)
      ASSERT_EQ(static_cast<std::int32_t>(arrays.edges[4 * i + 3]), judged.mesh.edges[i].marker);
    weft_mesh_free(made);
  }

  std::string reason_and_field() const {
    weft_error* error = nullptr;
    EXPECT_EQ(weft_make(&request, nullptr, &error), nullptr);
    const std::string told = std::string(weft_error_reason(error)) + " " + weft_error_field(error);
    weft_error_free(error);
    return told;
  }
};

TEST(CInterface, TakesConstants) {
  Given given;
  given.request.size_kind = WEFT_SIZE_CONSTANT;
  given.request.size_measure = WEFT_MEASURE_EDGE;
  given.request.size_constant = 0.2;
  given.request.min_angle_deg = given.same.min_angle_deg = 28;
  given.request.placement = WEFT_PLACEMENT_CIRCUMCENTRE;
  given.same.placement = Placement::kCircumcentre;
  given.request.sweeps = 1;
  given.same.sweeps = 1;
  given.same.size = 0.2;
  given.same.size.measure = Measure::kEdge;
  given.expect_same();
}

TEST(CInterface, TakesRastersAndLengthsAtMarkers) {
  Given given;
  const std::array<double, 4> values{0.01, 0.02, 0.03, 0.1};
  const weft_size_at at{3, 0.05};
  given.request.size_kind = WEFT_SIZE_RASTER;
  given.request.size_grid = {0, 0, 4, 4, 2, 2};
  given.request.size_values = values.data();
  given.request.sizes_at = &at;
  given.request.size_at_count = 1;
  given.request.gradation = given.same.size.gradation = 0.3;
  given.same.size = Raster{{0, 0}, 4, 4, 2, 2, {values.begin(), values.end()}};
  given.same.size.gradation = 0.3;
  given.same.size.at = {{3, 0.05}};
  given.expect_same();
}

// The checker cannot judge sizes by the width: it is given and not named.
TEST(CInterface, TakesFieldsOfAllKinds) {
  Given given;
  const std::array<std::int32_t, 1> markers{3};
  const std::array<float, 4> depths{1, 2, 3, 4};
  const std::array<double, 6> triangle{0, 0, 9, 0, 0, 9};
  const std::array<std::uint32_t, 3> corners{0, 1, 2};
  const std::array<double, 3> heights{1, 2, 3};
  std::array<weft_field, 4> fields{};
  fields[0].name = "wall";
  fields[0].kind = WEFT_FIELD_DISTANCE;
  fields[0].markers = markers.data();
  fields[0].marker_count = 1;
  fields[1].name = "depth";
  fields[1].kind = WEFT_FIELD_RASTER;
  fields[1].grid = {0, 0, 4, 4, 2, 2};
  fields[1].grid_values = depths.data();
  fields[2].name = "height";
  fields[2].kind = WEFT_FIELD_MESH;
  fields[2].points = triangle.data();
  fields[2].point_count = 3;
  fields[2].triangles = corners.data();
  fields[2].triangle_count = 1;
  fields[2].point_values = heights.data();
  fields[3].name = "across";
  fields[3].kind = WEFT_FIELD_WIDTH;
  const std::string size = "0.01 + 0.02 * wall + 1e-3 * depth + 1e-3 * height";
  given.request.size_kind = WEFT_SIZE_EXPRESSION;
  given.request.size_expression = size.c_str();
  given.request.fields = fields.data();
  given.request.field_count = fields.size();
  given.same.size = size;
  given.same.size.fields = {{"wall", DistanceSpec{{3}}},
                            {"depth", FieldRaster{{0, 0}, 4, 4, 2, 2, {1, 2, 3, 4}}},
                            {"height", FieldMesh{{{0, 0}, {9, 0}, {0, 9}}, {{0, 1, 2}}, {1, 2, 3}}},
                            {"across", WidthSpec{}}};
  given.expect_same();
}

TEST(CInterface, Simplifies) {
  Given given;
  given.request.simplify = given.same.simplify = 6;  // of the region's edges of 0.3
  given.expect_same();
  weft_mesh* const made = weft_make(&given.request, nullptr, nullptr);
  ASSERT_NE(made, nullptr);
  weft_summary told WEFT_SUMMARY;
  weft_mesh_summary(made, &told);
  EXPECT_EQ(told.has_simplification, 1);
  EXPECT_EQ(told.simplified_points, 4u);
  EXPECT_EQ(told.dropped_islands, 1u);
  EXPECT_EQ(told.simplified_area, 1);
  weft_mesh_free(made);
}

TEST(CInterface, TakesAreas) {
  Given given;
  const std::array<std::uint32_t, 8> areas{0, 0, 0, 0, 1, 1, 1, 1};
  const std::array<weft_area, 2> of{weft_area{1, 5, 0, 0, {1, 0, 0.05, 0}},
                                    weft_area{0, 0, 0, 1, {}}};
  given.request.segment_areas = areas.data();
  given.request.areas = of.data();
  given.request.area_count = of.size();
  given.request.fill = WEFT_FILL_UNION;
  given.request.hole_count = 0;
  given.same.pslg.holes.clear();
  for (std::size_t i = 0; i < areas.size(); ++i) given.same.pslg.segments[i].area = areas[i];
  given.same.pslg.areas = {{.region = 5, .max_area = 0.05}, {.is_hole = true}};
  given.same.pslg.fill = Fill::kUnion;
  given.expect_same();
}

TEST(CInterface, NamesWhatItCannotTake) {
  Given given;
  given.request.fill = 3;
  EXPECT_EQ(given.reason_and_field(), "BAD_OPTION domain.fill");
  given.request.fill = 0;
  // The squares of the last two are 0 and infinite.
  for (const double edge : {0.0, -1.0, 1e-200, 1e200}) {
    given.region.bound.max_edge = edge;
    EXPECT_EQ(given.reason_and_field(), "BAD_OPTION domain.regions[0].max_edge") << edge;
  }
  given.region.bound.max_edge = 1;
  given.region.bound.has_max_area = 1;
  EXPECT_EQ(given.reason_and_field(), "BAD_OPTION domain.regions[0].max_area");
  given.region.bound.max_area = 1e200;
  given.request.size_kind = WEFT_SIZE_RASTER;
  EXPECT_EQ(given.reason_and_field(), "BAD_OPTION size.raster.dx");
  given.request.size_kind = 9;
  EXPECT_EQ(given.reason_and_field(), "BAD_OPTION size");
  given.request.size_kind = 0;
  given.segments[3] = 8;
  EXPECT_EQ(given.reason_and_field(), "INDEX_OUT_OF_RANGE domain.segments[1].b");
}

// TBB's threads do not go over to a child, which would wait for them.
TEST(CInterface, ServesAChildOfForkToo) {
  Given given;
  given.request.size_kind = WEFT_SIZE_CONSTANT;
  given.request.size_constant = 1e-5;
  weft_control control = WEFT_CONTROL;
  control.threads = 2;
  const auto make = [&] {
    weft_mesh* const mesh = weft_make(&given.request, &control, nullptr);
    weft_summary told WEFT_SUMMARY;
    if (mesh != nullptr) weft_mesh_summary(mesh, &told);
    weft_mesh_free(mesh);
    return told.threads == 2;
  };
  EXPECT_TRUE(make());
  const pid_t child = ::fork();
  if (child == 0) {
    ::alarm(300);
    ::_exit(make() ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_TRUE(make());
}

}  // namespace
}  // namespace weft
