// SPDX-License-Identifier: Apache-2.0
#include "wire/request.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "weft/v1/mesh_service.pb.h"

namespace weft::wire {
namespace {

v1::SizeField constant(double value) {
  v1::SizeField size;
  size.set_constant(value);
  return size;
}

v1::SizeField expression(const char* source) {
  v1::SizeField size;
  size.set_expression(source);
  return size;
}

v1::SizeField raster() {
  v1::SizeField size;
  v1::Raster& raster = *size.mutable_raster();
  raster.set_x(1);
  raster.set_y(2);
  raster.set_dx(3);
  raster.set_dy(4);
  raster.set_columns(2);
  raster.set_rows(2);
  for (const double value : {0.5, 0.25, 0.5, 0.25}) raster.add_values(value);
  return size;
}

// Of a request with a domain.
Result<Request> read(const v1::SizeField& size) {
  v1::GenerateMeshRequest request;
  request.mutable_domain();
  *request.mutable_size() = size;
  return read_request(request.SerializeAsString());
}

SizeSpec to_engine(const v1::SizeField& size) {
  const auto request = read(size);
  EXPECT_TRUE(request) << request.error().message;
  return request ? request->mesh.size : SizeSpec{};
}

// The field that is refused, here or by the engine, or "".
std::string refused(const v1::SizeField& size) {
  const auto request = read(size);
  if (!request) return request.error().field;
  auto error = check_size(request->mesh.size);
  if (const auto* raster = std::get_if<Raster>(&request->mesh.size.value); raster && !error)
    error = check_raster_values(raster->values, raster->columns);
  return error ? error->field : "";
}

TEST(ReadSize, OfEachKindReachesTheEngine) {
  EXPECT_TRUE(std::holds_alternative<std::monostate>(to_engine(v1::SizeField()).value));
  EXPECT_EQ(std::get<double>(to_engine(constant(0.25)).value), 0.25);
  EXPECT_EQ(std::get<std::string>(to_engine(expression("1 + x")).value), "1 + x");
  const auto spec = to_engine(raster());
  const Raster& values = std::get<Raster>(spec.value);
  EXPECT_EQ(values.origin, (Point{1, 2}));
  EXPECT_EQ(values.dx, 3);
  EXPECT_EQ(values.dy, 4);
  EXPECT_EQ(values.columns, 2u);
  EXPECT_EQ(values.rows, 2u);
  EXPECT_EQ(values.values, (std::vector<double>{0.5, 0.25, 0.5, 0.25}));
}

TEST(ReadSize, BringsItsFieldsItsMeasureAndItsGradation) {
  v1::SizeField size = expression("a + b + c + d");
  size.set_measure(v1::MEASURE_EDGE);
  size.set_gradation(0.25);
  size.set_gradation_within(true);
  size.set_cells_across(3);
  size.set_points_per_circle(36);
  size.add_at()->set_marker(-2);
  size.mutable_at(0)->set_max_edge(0.5);
  for (const char* const name : {"a", "b", "c", "d"}) size.add_fields()->set_name(name);
  v1::Distance& distance = *size.mutable_fields(0)->mutable_distance();
  for (const double x : {1, 2, 3, 4}) distance.add_points(x);
  for (const unsigned i : {0, 1}) distance.add_segments(i);
  distance.add_markers(-3);
  v1::FieldRaster& values = *size.mutable_fields(1)->mutable_raster();
  values.set_x(5);
  values.set_dx(1);
  values.set_dy(6);
  values.set_columns(1);
  values.set_rows(2);
  values.add_values(0.5f);
  values.add_values(std::nanf(""));
  v1::FieldMesh& mesh = *size.mutable_fields(2)->mutable_mesh();
  for (const double x : {1, 2, 3, 4, 5, 6}) mesh.add_vertices(x);
  for (const unsigned i : {2, 1, 0}) mesh.add_triangles(i);
  for (const double v : {7, 8, 9}) mesh.add_values(v);
  size.mutable_fields(3)->mutable_width();

  const SizeSpec spec = to_engine(size);
  EXPECT_EQ(spec.measure, Measure::kEdge);
  EXPECT_EQ(spec.gradation, 0.25);
  EXPECT_TRUE(spec.gradation_within);
  EXPECT_EQ(spec.cells_across, 3);
  EXPECT_EQ(spec.points_per_circle, 36);
  ASSERT_EQ(spec.at.size(), 1u);
  EXPECT_EQ(spec.at[0].marker, -2);
  EXPECT_EQ(spec.at[0].max_edge, 0.5);
  ASSERT_EQ(spec.fields.size(), 4u);
  EXPECT_EQ(spec.fields[3].name, "d");
  const auto& to = std::get<DistanceSpec>(spec.fields[0].kind);
  EXPECT_EQ(to.points, (std::vector<Point>{{1, 2}, {3, 4}}));
  EXPECT_EQ(to.segments, (std::vector<std::array<std::uint32_t, 2>>{{0, 1}}));
  EXPECT_EQ(to.markers, std::vector<std::int32_t>{-3});
  const auto& raster = std::get<FieldRaster>(spec.fields[1].kind);
  EXPECT_EQ(raster.origin, (Point{5, 0}));
  EXPECT_EQ(raster.dy, 6);
  EXPECT_EQ(raster.rows, 2u);
  EXPECT_EQ(raster.values[0], 0.5f);
  EXPECT_TRUE(std::isnan(raster.values[1]));
  const auto& triangles = std::get<FieldMesh>(spec.fields[2].kind);
  EXPECT_EQ(triangles.vertices[2], (Point{5, 6}));
  EXPECT_EQ(triangles.triangles[0], (std::array<std::uint32_t, 3>{2, 1, 0}));
  EXPECT_EQ(triangles.values, (std::vector<double>{7, 8, 9}));
  EXPECT_TRUE(std::holds_alternative<WidthSpec>(spec.fields[3].kind));
}

TEST(ReadSize, MayNameItsFieldsAlone) {
  v1::SizeField size = expression("1 + coast");
  EXPECT_EQ(refused(size), "size.expression");
  v1::NamedField& field = *size.add_fields();
  field.set_name("coast");
  field.mutable_distance();
  EXPECT_EQ(refused(size), "");
}

TEST(ReadSize, WithAFaultIsRefusedByItsName) {
  EXPECT_EQ(refused(v1::SizeField()), "");
  EXPECT_EQ(refused(constant(1)), "");
  EXPECT_EQ(refused(constant(-1)), "size.constant");
  EXPECT_EQ(refused(expression("1 + x")), "");
  EXPECT_EQ(refused(expression("1 +")), "size.expression");
  EXPECT_EQ(refused(expression("-1")), "size.expression");
  EXPECT_EQ(refused(raster()), "");
  v1::SizeField size = raster();
  size.mutable_raster()->set_values(3, 0);
  EXPECT_EQ(refused(size), "size.raster.values[3]");
  size = raster();
  size.mutable_raster()->set_rows(3);
  EXPECT_EQ(refused(size), "size.raster.values");
  size = raster();
  size.mutable_raster()->set_dx(0);
  EXPECT_EQ(refused(size), "size.raster.dx");
  size = raster();
  size.mutable_raster()->set_y(std::numeric_limits<double>::infinity());
  EXPECT_EQ(refused(size), "size.raster.y");
}

void add_sides(v1::Quality& quality, std::int32_t from, std::int32_t to) {
  v1::PeriodicSides& sides = *quality.add_periodic();
  sides.set_from(from);
  sides.set_to(to);
}

using Sides = std::vector<std::pair<std::int32_t, std::int32_t>>;
Sides sides_of(const Request& request) {
  Sides sides;
  for (const PeriodicPair& pair : request.mesh.periodic) sides.emplace_back(pair.from, pair.to);
  return sides;
}

v1::GenerateMeshRequest full_request() {
  v1::GenerateMeshRequest request;
  v1::Domain& domain = *request.mutable_domain();
  for (const double x : {0., 0., 4., 0., 0., 4.}) domain.add_points(x);
  for (const unsigned i : {0, 1, 1, 2, 2, 0}) domain.add_segments(i);
  for (const int marker : {-1, 2, 300}) domain.add_segment_markers(marker);
  for (const unsigned area : {0, 1, 1}) domain.add_segment_areas(area);
  for (const double x : {1., 2.}) domain.add_holes(x);
  v1::Region& region = *domain.add_regions();
  region.set_x(3);
  region.set_y(5);
  region.set_id(-7);
  region.set_max_area(0.5);
  region.set_max_edge(0.1);
  v1::Area& area = *domain.add_areas();
  area.set_region(-8);
  area.set_max_area(0.25);
  area.set_priority(-9);
  area.set_hole(true);
  domain.add_arc_segments(2);
  domain.add_arc_bulges(-0.5);
  domain.set_fill(v1::FILL_UNION);
  domain.set_snap(0.125);
  v1::Quality& quality = *request.mutable_quality();
  quality.set_min_angle_deg(28);
  quality.set_min_edge(0.01);
  quality.set_placement(v1::PLACEMENT_CIRCUMCENTRE);
  quality.set_optimise(3);
  quality.mutable_keep()->add_markers(-1);
  quality.mutable_keep()->add_markers(300);
  add_sides(quality, -4, 2);
  add_sides(quality, 0, 3);
  v1::Budget& budget = *request.mutable_budget();
  budget.set_max_triangles(std::uint64_t{1} << 40);
  budget.set_max_bytes(11);
  budget.set_max_seconds(12);
  request.set_threads(13);
  request.set_want_quadtree(true);
  request.set_allow_unrefined(true);
  request.set_simplify(0.75);
  for (const double x : {0.5, 1., 2., 0.25}) request.add_sample_points(x);
  return request;
}

TEST(ReadRequest, BringsLayers) {
  v1::GenerateMeshRequest request = full_request();
  v1::Layers& full = *request.mutable_quality()->add_layers();
  full.set_marker(-2);
  full.set_first(0.5);
  full.set_ratio(1.25);
  full.set_rows(7);
  full.set_region(0);
  request.mutable_quality()->add_layers()->set_first(1);
  const auto read = read_request(request.SerializeAsString());
  ASSERT_TRUE(read);
  const std::vector<Layers>& layers = read->mesh.layers;
  ASSERT_EQ(layers.size(), 2u);
  EXPECT_EQ(layers[0].marker, -2);
  EXPECT_EQ(layers[0].first, 0.5);
  EXPECT_EQ(layers[0].ratio, 1.25);
  EXPECT_EQ(layers[0].rows, 7u);
  EXPECT_EQ(layers[0].region, 0);
  EXPECT_EQ(layers[1].ratio, 1) << "the default";
  EXPECT_EQ(layers[1].rows, 0u) << "which the engine refuses";
  EXPECT_FALSE(layers[1].region);
}

TEST(ReadRequest, BringsTheDomain) {
  const auto request = read_request(full_request().SerializeAsString());
  ASSERT_TRUE(request) << request.error().message;
  const Pslg& pslg = request->mesh.pslg;
  EXPECT_EQ(pslg.points, (std::vector<Point>{{0, 0}, {4, 0}, {0, 4}}));
  ASSERT_EQ(pslg.segments.size(), 3u);
  EXPECT_EQ(pslg.segments[0].b, 1u);
  EXPECT_EQ(pslg.segments[0].marker, -1);
  EXPECT_EQ(pslg.segments[0].area, kNone);
  EXPECT_EQ(pslg.segments[2].a, 2u);
  EXPECT_EQ(pslg.segments[2].marker, 300);
  EXPECT_EQ(pslg.segments[2].area, 0u);
  EXPECT_EQ(pslg.holes, (std::vector<Point>{{1, 2}}));
  ASSERT_EQ(pslg.regions.size(), 1u);
  EXPECT_EQ(pslg.regions[0].at, (Point{3, 5}));
  EXPECT_EQ(pslg.regions[0].id, -7);
  EXPECT_EQ(pslg.regions[0].max_area, area_of_edge(0.1));
  ASSERT_EQ(pslg.areas.size(), 1u);
  EXPECT_EQ(pslg.areas[0].region, -8);
  EXPECT_EQ(pslg.areas[0].max_area, 0.25);
  EXPECT_EQ(pslg.areas[0].priority, -9);
  EXPECT_TRUE(pslg.areas[0].is_hole);
  ASSERT_EQ(pslg.arcs.size(), 1u);
  EXPECT_EQ(pslg.arcs[0].segment, 2u);
  EXPECT_EQ(pslg.arcs[0].bulge, -0.5);
  EXPECT_EQ(pslg.fill, Fill::kUnion);
  EXPECT_EQ(pslg.snap, 0.125);
}

TEST(ReadRequest, BringsTheOptions) {
  const auto request = read_request(full_request().SerializeAsString());
  ASSERT_TRUE(request) << request.error().message;
  EXPECT_EQ(request->mesh.min_angle_deg, 28);
  EXPECT_EQ(request->mesh.min_edge, 0.01);
  EXPECT_EQ(request->mesh.placement, Placement::kCircumcentre);
  EXPECT_EQ(request->mesh.sweeps, 3u);
  EXPECT_EQ(request->mesh.keep, (std::vector<std::int32_t>{-1, 300}));
  EXPECT_EQ(sides_of(*request), (Sides{{-4, 2}, {0, 3}}));
  EXPECT_EQ(request->mesh.simplify, 0.75);
  EXPECT_EQ(request->mesh.sample_points, (std::vector<Point>{{0.5, 1}, {2, 0.25}}));
  EXPECT_TRUE(request->mesh.allow_unrefined);
  EXPECT_EQ(request->max_triangles, std::uint64_t{1} << 40);
  EXPECT_EQ(request->max_bytes, 11u);
  EXPECT_EQ(request->max_seconds, 12);
  EXPECT_EQ(request->threads, 13u);
  EXPECT_TRUE(request->want_quadtree);
}

TEST(ReadRequest, TakesWhatIsLeftOutForItsDefault) {
  v1::GenerateMeshRequest empty;
  empty.mutable_domain();
  const auto request = read_request(empty.SerializeAsString());
  ASSERT_TRUE(request);
  EXPECT_EQ(request->mesh.min_angle_deg, MeshRequest{}.min_angle_deg);
  EXPECT_EQ(request->mesh.placement, Placement::kLattice);
  EXPECT_EQ(request->mesh.sweeps, std::nullopt);
  EXPECT_EQ(request->mesh.keep, std::nullopt);
  EXPECT_EQ(sides_of(*request), Sides());
  EXPECT_EQ(request->mesh.pslg.fill, Fill::kSeeds);
}

TEST(ReadRequest, MergesWhatComesInParts) {
  v1::GenerateMeshRequest first = full_request();
  v1::GenerateMeshRequest second;
  second.mutable_domain()->add_points(9);
  second.mutable_domain()->add_points(8);
  second.mutable_quality()->set_min_edge(7);
  second.mutable_quality()->mutable_keep()->add_markers(5);
  add_sides(*second.mutable_quality(), 6, 7);
  second.mutable_size()->set_gradation(6);
  const auto request = read_request(first.SerializeAsString() + second.SerializeAsString());
  ASSERT_TRUE(request) << request.error().message;
  EXPECT_EQ(request->mesh.pslg.points.size(), 4u);
  EXPECT_EQ(request->mesh.pslg.fill, Fill::kUnion);
  EXPECT_EQ(request->mesh.min_edge, 7);
  EXPECT_EQ(request->mesh.keep, (std::vector<std::int32_t>{-1, 300, 5}));
  EXPECT_EQ(sides_of(*request), (Sides{{-4, 2}, {0, 3}, {6, 7}}));
  EXPECT_EQ(request->mesh.min_angle_deg, 28);
  EXPECT_EQ(request->mesh.placement, Placement::kCircumcentre);
}

// Half a million parts of two points each: to grow by each part would take hours.
TEST(ReadRequest, TakesAnArrayInAnyNumberOfParts) {
  v1::GenerateMeshRequest part;
  for (const double at : {1, 2, 3, 4}) part.mutable_domain()->add_points(at);
  const std::string bytes = part.SerializeAsString();
  constexpr std::size_t kParts = 500'000;
  std::string message;
  message.reserve(kParts * bytes.size());
  for (std::size_t i = 0; i < kParts; ++i) message += bytes;
  const auto request = read_request(message);
  ASSERT_TRUE(request) << request.error().message;
  EXPECT_EQ(request->mesh.pslg.points.size(), 2 * kParts);
}

// The code and the field that are refused.
std::pair<ErrorCode, std::string> fault_of(const v1::GenerateMeshRequest& message) {
  const auto request = read_request(message.SerializeAsString());
  if (request) return {ErrorCode::kInternal, "none"};
  EXPECT_NE(request.error().message, "");
  return {request.error().code, request.error().field};
}

TEST(ReadRequest, NamesArraysWhoseLengthsMakeNoSense) {
  const auto expect = [](const char* field, auto&& spoil) {
    v1::GenerateMeshRequest request = full_request();
    spoil(*request.mutable_domain());
    EXPECT_EQ(fault_of(request), (std::pair{ErrorCode::kBadArray, std::string(field)}));
  };
  expect("domain.points", [](v1::Domain& domain) { domain.add_points(1); });
  expect("domain.segments", [](v1::Domain& domain) { domain.add_segments(1); });
  expect("domain.holes", [](v1::Domain& domain) { domain.add_holes(1); });
  expect("domain.segment_markers", [](v1::Domain& domain) { domain.add_segment_markers(1); });
  expect("domain.segment_areas", [](v1::Domain& domain) { domain.add_segment_areas(1); });
  expect("domain.arc_bulges", [](v1::Domain& domain) { domain.add_arc_bulges(1); });
  v1::GenerateMeshRequest odd = full_request();
  odd.add_sample_points(1);
  EXPECT_EQ(fault_of(odd), (std::pair{ErrorCode::kBadArray, std::string("sample_points")}));
}

TEST(ReadRequest, NamesOptionsThatAreNone) {
  const auto expect = [](const char* field, auto&& spoil) {
    v1::GenerateMeshRequest request = full_request();
    spoil(request);
    EXPECT_EQ(fault_of(request), (std::pair{ErrorCode::kBadOption, std::string(field)}));
  };
  using Message = v1::GenerateMeshRequest;
  expect("domain", [](Message& m) { m.clear_domain(); });
  expect("domain.fill", [](Message& m) { m.mutable_domain()->set_fill(v1::Fill(4)); });
  expect("size.measure", [](Message& m) { m.mutable_size()->set_measure(v1::Measure(-1)); });
  expect("quality.placement",
         [](Message& m) { m.mutable_quality()->set_placement(v1::Placement(3)); });
  expect("domain.regions[0].max_edge",
         [](Message& m) { m.mutable_domain()->mutable_regions(0)->set_max_edge(1e200); });
  expect("domain.areas[0].max_area",
         [](Message& m) { m.mutable_domain()->mutable_areas(0)->set_max_area(0); });
  expect("size.fields[0]", [](Message& m) { m.mutable_size()->add_fields()->set_name("d"); });
  expect("budget.max_seconds", [](Message& m) { m.mutable_budget()->set_max_seconds(-1); });
}

TEST(ReadRequest, RefusesEveryBeginningThatIsNoMessage) {
  const std::string bytes = full_request().SerializeAsString();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const std::string beginning = bytes.substr(0, size);
    const bool parses = v1::GenerateMeshRequest().ParseFromString(beginning);
    const auto request = read_request(beginning);
    EXPECT_EQ(!request && request.error().code == ErrorCode::kMalformedRequest, !parses) << size;
  }
}

}  // namespace
}  // namespace weft::wire
