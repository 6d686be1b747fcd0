// SPDX-License-Identifier: Apache-2.0
#include "server/wire/size_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace weft::server {
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

// The field that is refused, or "".
std::string refused(const v1::SizeField& size) {
  if (const auto failure = check_shape(size)) return failure->field;
  const auto failure = check_values(size);
  return failure ? failure->field : "";
}

TEST(SizeField, OfEachKindReachesTheEngine) {
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

TEST(SizeField, BringsItsFieldsItsMeasureAndItsGradation) {
  v1::SizeField size = expression("a + b + c + d");
  size.set_measure(v1::MEASURE_EDGE);
  size.set_gradation(0.25);
  size.set_gradation_within(true);
  size.set_cells_across(3);
  size.add_at()->set_marker(-2);
  size.mutable_at(0)->set_max_edge(0.5);
  for (const char* const name : {"a", "b", "c", "d"}) size.add_fields()->set_name(name);
  v1::Distance& distance = *size.mutable_fields(0)->mutable_distance();
  for (const double x : {1, 2, 3, 4}) distance.add_points(x);
  for (const unsigned i : {0, 1}) distance.add_segments(i);
  distance.add_markers(-3);
  v1::FieldRaster& values = *size.mutable_fields(1)->mutable_raster();
  values.set_x(5);
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

TEST(SizeField, MayNameItsFieldsAlone) {
  v1::SizeField size = expression("1 + coast");
  EXPECT_EQ(refused(size), "size.expression");
  v1::NamedField& field = *size.add_fields();
  field.set_name("coast");
  field.mutable_distance();
  EXPECT_EQ(refused(size), "");
}

TEST(SizeField, WithAFaultIsRefusedByItsName) {
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

}  // namespace
}  // namespace weft::server
