// SPDX-License-Identifier: Apache-2.0
// Towards the wire; what comes from the wire is tested over a socket, in mesh_service_test.cpp.
#include "server/wire/translate.h"

#include <gtest/gtest.h>

#include "wire/summary.h"

namespace weft::server {
namespace {

Chunk full_chunk() {
  Chunk chunk;
  chunk.index = 3;
  chunk.first_vertex = 10;
  chunk.first_triangle = 20;
  chunk.coordinates = {0.1, 0.2, 0.3, 0.4};
  chunk.triangles = {1, 2, 3, 0xfffffffe, 5, 6};
  chunk.regions = {-1, 7};
  chunk.edges = {{1, 2, 8, 0}, {2, 3, 9, -4}};
  chunk.bulges = {0, -0.25};
  chunk.input_points = {{10, 0}, {11, 5}};
  chunk.box = {0, 1, 2, 3};
  chunk.digest.fill(0xab);
  return chunk;
}

template <class Array>
auto vector_of(const Array& array) {
  return std::vector(array.begin(), array.end());
}

TEST(ChunkToWire, CarriesEveryArray) {
  v1::Chunk message;
  to_wire(full_chunk(), message);
  EXPECT_EQ(message.index(), 3u);
  EXPECT_EQ(message.first_vertex(), 10u);
  EXPECT_EQ(message.first_triangle(), 20u);
  EXPECT_EQ(vector_of(message.coordinates()), (std::vector<double>{0.1, 0.2, 0.3, 0.4}));
  EXPECT_EQ(vector_of(message.triangles()),
            (std::vector<std::uint32_t>{1, 2, 3, 0xfffffffe, 5, 6}));
  EXPECT_EQ(vector_of(message.regions()), (std::vector<std::int32_t>{-1, 7}));
  EXPECT_EQ(vector_of(message.edges()), (std::vector<std::uint32_t>{1, 2, 2, 3}));
  EXPECT_EQ(vector_of(message.edge_markers()), (std::vector<std::int32_t>{0, -4}));
  EXPECT_EQ(vector_of(message.edge_segments()), (std::vector<std::uint32_t>{8, 9}));
  EXPECT_EQ(vector_of(message.edge_bulges()), (std::vector<double>{0, -0.25}));
  EXPECT_EQ(vector_of(message.input_points()), (std::vector<std::uint32_t>{10, 0, 11, 5}));
  EXPECT_EQ(vector_of(message.box()), (std::vector<double>{0, 1, 2, 3}));
  EXPECT_EQ(message.sha256(), std::string(32, '\xab'));
}

TEST(ChunkToWire, LeavesMarkersOutWhereAllAreZero) {
  Chunk chunk = full_chunk();
  chunk.edges[1].marker = 0;
  v1::Chunk message;
  to_wire(chunk, message);
  EXPECT_EQ(message.edge_markers_size(), 0);
  EXPECT_EQ(message.edge_segments_size(), 2);
}

TEST(ChunkToWire, LeavesNothingOfTheChunkBefore) {
  v1::Chunk used;
  to_wire(full_chunk(), used);
  v1::Chunk fresh;
  to_wire(Chunk{}, used);
  to_wire(Chunk{}, fresh);
  EXPECT_EQ(used.SerializeAsString(), fresh.SerializeAsString());
}

TEST(SummaryToWire, CarriesEveryFigure) {
  Summary summary;
  summary.vertices = 1;
  summary.triangles = 2;
  summary.edges = 3;
  summary.chunks = 4;
  summary.area = 5;
  summary.min_angle_deg = 6;
  summary.max_angle_deg = 7;
  summary.min_angle_p1_deg = 41;
  summary.mean_quality = 42;
  summary.ideal_ratio = 43;
  summary.lattice_share = 44;
  summary.streamed = true;
  summary.angle_histogram[17] = 8;
  summary.aspect_histogram[8] = 9;
  summary.size_histogram[9] = 10;
  summary.unrefined = {11, 12, 61, 13, 27, 28, 29};
  summary.unrefined_at = {30, 31};
  summary.kept_at = {62, 63};
  summary.narrow = NarrowPlace{51, 52, {53, 54}, 55, 56, 57, 58};
  summary.outside = {65, 66, {67, 68}};
  summary.simplified = Simplification{57, 58, 59, 60, 63, 64, 61, 62, {}};
  summary.merging = {32, 33, 34, 35, {36, 37}, 38, {39, 40}};
  summary.triangulate_seconds = 14;
  summary.size_seconds = 15;
  summary.coarse_seconds = 15.5;
  summary.refine_seconds = 16;
  summary.emit_seconds = 17;
  summary.engine_seconds = 18;
  summary.peak_bytes = 19;
  summary.insertions = 20;
  summary.exact_predicates = 21;
  summary.digest.fill(22);
  summary.deferred = 23;
  summary.rounds = 24;
  summary.leaves.resize(25);
  summary.size_warnings = {{SizeWarning::Kind::kCoarseRaster, "depth", "is coarse"},
                           {SizeWarning::Kind::kBoundsNothing, "", "is large"},
                           {SizeWarning::Kind::kFieldNotNamed, "d", "is not named"},
                           {SizeWarning::Kind::kGradationWithinAlone, "", "is alone"}};
  const v1::Summary message = to_wire(summary, 26);
  EXPECT_EQ(message.vertices(), 1u);
  EXPECT_EQ(message.triangles(), 2u);
  EXPECT_EQ(message.edges(), 3u);
  EXPECT_EQ(message.chunks(), 4u);
  EXPECT_EQ(message.area(), 5);
  EXPECT_EQ(message.min_angle_deg(), 6);
  EXPECT_EQ(message.max_angle_deg(), 7);
  EXPECT_EQ(message.min_angle_p1_deg(), 41);
  EXPECT_EQ(message.mean_quality(), 42);
  EXPECT_EQ(message.ideal_ratio(), 43);
  EXPECT_EQ(message.lattice_share(), 44);
  EXPECT_TRUE(message.streamed());
  ASSERT_EQ(message.size_warnings_size(), 4);
  EXPECT_EQ(message.size_warnings(0).kind(), v1::SIZE_WARNING_KIND_COARSE_RASTER);
  EXPECT_EQ(message.size_warnings(0).field(), "depth");
  EXPECT_EQ(message.size_warnings(0).message(), "is coarse");
  EXPECT_EQ(message.size_warnings(1).kind(), v1::SIZE_WARNING_KIND_BOUNDS_NOTHING);
  EXPECT_EQ(message.size_warnings(2).kind(), v1::SIZE_WARNING_KIND_FIELD_NOT_NAMED);
  EXPECT_EQ(message.size_warnings(3).kind(), v1::SIZE_WARNING_KIND_GRADATION_WITHIN_ALONE);
  ASSERT_EQ(message.angle_histogram_size(), 18);
  EXPECT_EQ(message.angle_histogram(17), 8u);
  ASSERT_EQ(message.aspect_histogram_size(), 9);
  EXPECT_EQ(message.aspect_histogram(8), 9u);
  ASSERT_EQ(message.size_histogram_size(), 10);
  EXPECT_EQ(message.size_histogram(9), 10u);
  EXPECT_EQ(message.unrefined().small_input_angle(), 11u);
  EXPECT_EQ(message.unrefined().edge_floor(), 12u);
  EXPECT_EQ(message.unrefined().budget(), 13u);
  EXPECT_EQ(message.unrefined().precision(), 27u);
  EXPECT_EQ(message.unrefined().streaming(), 28u);
  EXPECT_EQ(message.unrefined().too_large(), 29u);
  EXPECT_EQ(message.unrefined().x(), 30);
  EXPECT_EQ(message.unrefined().y(), 31);
  EXPECT_EQ(message.unrefined().kept(), 61u);
  EXPECT_EQ(message.unrefined().kept_x(), 62);
  EXPECT_EQ(message.unrefined().kept_y(), 63);
  EXPECT_EQ(message.narrow().segment(), 51u);
  EXPECT_EQ(message.narrow().other(), 52u);
  EXPECT_EQ(message.narrow().x(), 53);
  EXPECT_EQ(message.narrow().y(), 54);
  EXPECT_EQ(message.narrow().width(), 55);
  EXPECT_EQ(message.narrow().triangles(), 56u);
  EXPECT_EQ(message.narrow().in_all(), 57u);
  EXPECT_EQ(message.narrow().widest(), 58);
  EXPECT_EQ(message.outside().segments(), 65u);
  EXPECT_EQ(message.outside().first(), 66u);
  EXPECT_EQ(message.outside().x(), 67);
  EXPECT_EQ(message.outside().y(), 68);
  EXPECT_EQ(message.simplification().points(), 57u);
  EXPECT_EQ(message.simplification().islands(), 58u);
  EXPECT_EQ(message.simplification().waters(), 59u);
  EXPECT_EQ(message.simplification().channels(), 60u);
  EXPECT_EQ(message.simplification().cut_off(), 63u);
  EXPECT_EQ(message.simplification().straits(), 64u);
  EXPECT_EQ(message.simplification().area(), 61);
  EXPECT_EQ(message.simplification().farthest(), 62);
  EXPECT_EQ(message.merging().tolerance(), 32);
  EXPECT_EQ(message.merging().points(), 33u);
  EXPECT_EQ(message.merging().segments(), 34u);
  EXPECT_EQ(message.merging().farthest(), 35);
  EXPECT_EQ(message.merging().farthest_x(), 36);
  EXPECT_EQ(message.merging().farthest_y(), 37);
  EXPECT_EQ(message.merging().vanished_faces(), 38u);
  EXPECT_EQ(message.merging().vanished_x(), 39);
  EXPECT_EQ(message.merging().vanished_y(), 40);
  EXPECT_EQ(message.timings().triangulate_seconds(), 14);
  EXPECT_EQ(message.timings().size_seconds(), 15);
  EXPECT_EQ(message.timings().prelude_seconds(), 15.5);
  EXPECT_EQ(message.timings().refine_seconds(), 16);
  EXPECT_EQ(message.timings().emit_seconds(), 17);
  EXPECT_EQ(message.timings().engine_seconds(), 18);
  EXPECT_EQ(message.peak_engine_bytes(), 19u);
  EXPECT_EQ(message.insertions(), 20u);
  EXPECT_EQ(message.exact_predicates(), 21u);
  EXPECT_EQ(message.sha256(), std::string(32, '\x16'));
  EXPECT_EQ(message.deferred(), 23u);
  EXPECT_EQ(message.rounds(), 24u);
  EXPECT_EQ(message.leaves(), 25u);
  EXPECT_EQ(message.leaf_boxes_size(), 0);
  EXPECT_EQ(message.threads(), 26u);
}

TEST(SummaryToWire, CarriesTheBoxesOfTheQuadtreeInOrder) {
  Summary summary;
  summary.leaves = {{1, 2, 3, 4}, {5, 6, 7, 8}};
  v1::Summary message;
  add_quadtree(summary, message);
  EXPECT_EQ(vector_of(message.leaf_boxes()), (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST(SummaryToWire, LeavesBoxesOutWhereAClientMightNotTakeThem) {
  constexpr std::size_t kMaxOfAClient = std::size_t{4} << 20;
  Summary summary;
  summary.leaves.resize(wire::kMaxLeafBoxes);
  v1::Summary message = to_wire(summary, 1);
  add_quadtree(summary, message);
  EXPECT_EQ(static_cast<std::size_t>(message.leaf_boxes_size()), 4 * wire::kMaxLeafBoxes);
  EXPECT_LT(message.ByteSizeLong(), kMaxOfAClient);
  summary.leaves.resize(wire::kMaxLeafBoxes + 1);
  message = to_wire(summary, 1);
  add_quadtree(summary, message);
  EXPECT_EQ(message.leaf_boxes_size(), 0);
  EXPECT_EQ(message.leaves(), wire::kMaxLeafBoxes + 1);
}

TEST(BudgetFromWire, ZeroMeansTheServersLimits) {
  Limits limits;
  limits.max_triangles = 100;
  limits.max_bytes = 200;
  limits.max_seconds = 300;
  const Budget budget = to_budget({}, limits);
  EXPECT_EQ(budget.max_triangles, Budget{}.max_triangles);
  EXPECT_EQ(budget.triangle_limit, 100u);
  EXPECT_EQ(budget.max_bytes, 200u);
  EXPECT_EQ(to_seconds({}, limits), 300);
}

}  // namespace
}  // namespace weft::server
