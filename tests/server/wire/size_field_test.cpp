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
  EXPECT_TRUE(std::holds_alternative<std::monostate>(to_engine(v1::SizeField())));
  EXPECT_EQ(std::get<double>(to_engine(constant(0.25))), 0.25);
  EXPECT_EQ(std::get<std::string>(to_engine(expression("1 + x"))), "1 + x");
  const auto spec = to_engine(raster());
  const Raster& values = std::get<Raster>(spec);
  EXPECT_EQ(values.origin, (Point{1, 2}));
  EXPECT_EQ(values.dx, 3);
  EXPECT_EQ(values.dy, 4);
  EXPECT_EQ(values.columns, 2u);
  EXPECT_EQ(values.rows, 2u);
  EXPECT_EQ(values.values, (std::vector<double>{0.5, 0.25, 0.5, 0.25}));
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

TEST(SizeField, IsEstimatedByASizeThatMakesAsManyTriangles) {
  const auto at = [](const v1::SizeField& size) { return (*size_to_estimate_by(size))({1, 2}); };
  EXPECT_TRUE(std::isinf(at(v1::SizeField())));
  EXPECT_EQ(at(constant(0.25)), 0.25);
  EXPECT_EQ(at(expression("x + y")), 3);
  EXPECT_DOUBLE_EQ(at(raster()), 1 / 3.0);  // half of it makes 2 and half 4 on a unit
  EXPECT_TRUE(std::isinf(at(expression("1 +")))) << "what is refused later asks for nothing";
  EXPECT_EQ(bytes_to_expect(raster()), 4 * 16);
  EXPECT_EQ(bytes_to_expect(expression("x")), 0);
}

}  // namespace
}  // namespace weft::server
