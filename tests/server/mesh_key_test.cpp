// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/mesh_key.h"

#include "tests/server/harness.h"

namespace weft::server::testing {
namespace {

TEST(MeshKey, LeavesOutWhatDoesNotChangeTheMesh) {
  v1::GenerateMeshRequest request = valid_request();
  const std::string key = mesh_key(request);
  EXPECT_EQ(key.size(), 32);
  request.set_threads(3);
  request.set_first_chunk(2);
  request.set_want_quadtree(true);
  request.set_no_cache(true);
  request.mutable_budget()->set_max_bytes(1 << 30);
  request.mutable_budget()->set_max_seconds(5);
  EXPECT_EQ(mesh_key(request), key);
}

TEST(MeshKey, IsTheSameForADefaultThatIsWrittenOut) {
  v1::GenerateMeshRequest request = valid_request();
  request.mutable_domain()->clear_segment_markers();
  const std::string key = mesh_key(request);
  request.mutable_quality()->set_min_angle_deg(20);
  request.mutable_quality()->set_placement(v1::PLACEMENT_LATTICE);
  request.mutable_domain()->set_fill(v1::FILL_SEEDS);
  request.mutable_domain()->set_snap(-0.0);
  for (int i = 0; i < 4; ++i) request.mutable_domain()->add_segment_markers(0);
  EXPECT_EQ(mesh_key(request), key);
}

struct Change {
  const char* name;
  void (*make)(v1::GenerateMeshRequest&);
};

class MeshKeyOf : public ::testing::TestWithParam<Change> {};

TEST_P(MeshKeyOf, AnotherMeshIsAnother) {
  v1::GenerateMeshRequest request = valid_request();
  const std::string key = mesh_key(request);
  GetParam().make(request);
  EXPECT_NE(mesh_key(request), key);
}

INSTANTIATE_TEST_SUITE_P(
    Changes, MeshKeyOf,
    ::testing::Values(
        Change{"Point", [](auto& r) { r.mutable_domain()->set_points(0, 0.5); }},
        Change{"Segment", [](auto& r) { r.mutable_domain()->set_segments(0, 2); }},
        Change{"Marker", [](auto& r) { r.mutable_domain()->set_segment_markers(0, 9); }},
        Change{"Hole", [](auto& r) { r.mutable_domain()->add_holes(1); }},
        Change{"Region", [](auto& r) { r.mutable_domain()->add_regions()->set_id(1); }},
        Change{"Fill", [](auto& r) { r.mutable_domain()->set_fill(v1::FILL_EVEN_ODD); }},
        Change{"Size", [](auto& r) { r.mutable_size()->set_constant(0.2); }},
        Change{"Expression", [](auto& r) { r.mutable_size()->set_expression("0.1"); }},
        Change{"Raster", [](auto& r) { r.mutable_size()->mutable_raster()->add_values(1); }},
        Change{"Angle", [](auto& r) { r.mutable_quality()->set_min_angle_deg(21); }},
        Change{"Snap", [](auto& r) { r.mutable_domain()->set_snap(1e-3); }},
        Change{"AllowUnrefined", [](auto& r) { r.set_allow_unrefined(true); }},
        Change{"Edge", [](auto& r) { r.mutable_quality()->set_min_edge(1); }},
        Change{"Placement",
               [](auto& r) { r.mutable_quality()->set_placement(v1::PLACEMENT_CIRCUMCENTRE); }},
        Change{"Optimise", [](auto& r) { r.mutable_quality()->set_optimise(0); }},
        Change{"Triangles", [](auto& r) { r.mutable_budget()->set_max_triangles(7); }}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(Sha256, IsThatOfTheStandard) {
  EXPECT_EQ(sha256("abc").substr(0, 4), std::string("\xba\x78\x16\xbf", 4));
}

}  // namespace
}  // namespace weft::server::testing
