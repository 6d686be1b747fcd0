// SPDX-License-Identifier: Apache-2.0
#include "checker/size/mesh_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace weft::check {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// The unit square in n x n cells of two triangles, one of them clockwise; values 1 + 2 x - 3 y.
MeshField square(std::uint32_t n) {
  MeshField field;
  for (std::uint32_t j = 0; j <= n; ++j) {
    for (std::uint32_t i = 0; i <= n; ++i) {
      const double x = static_cast<double>(i) / n, y = static_cast<double>(j) / n;
      field.vertices.push_back({x, y});
      field.values.push_back(1 + 2 * x - 3 * y);
      if (i == n || j == n) continue;
      const std::uint32_t at = j * (n + 1) + i;
      field.triangles.push_back({at, at + 1, at + n + 1});
      field.triangles.push_back({at + 1, at + n + 1, at + n + 2});
    }
  }
  return field;
}

std::string error_of(const MeshField& field) {
  const auto made = MeshValues::make(field);
  return made ? "" : made.error();
}

TEST(CheckersMeshField, IsExactForWhatIsLinear) {
  const MeshField field = square(7);
  const MeshValues values = *MeshValues::make(field);
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> place(0, 1);
  for (int k = 0; k < 1000; ++k) {
    const Vec2 p{place(random), place(random)};
    EXPECT_NEAR(values.value(p), 1 + 2 * p.x - 3 * p.y, 1e-14);
    EXPECT_NEAR(values.slope(p), std::sqrt(13), 1e-13);
  }
}

TEST(CheckersMeshField, IsOutsideThatOfTheNearestPoint) {
  const MeshField field = square(7);
  const MeshValues values = *MeshValues::make(field);
  EXPECT_NEAR(values.value({0.3, -2}), 1 + 2 * 0.3, 1e-14);
  EXPECT_NEAR(values.value({1.5, 0.6}), 3 - 3 * 0.6, 1e-14);
  EXPECT_NEAR(values.value({5, -7}), 3, 1e-14);
  EXPECT_NEAR(values.slope({0.3, -2}), std::sqrt(13), 1e-13);
}

TEST(CheckersMeshField, IsUndefinedBesideAVertexThatIs) {
  MeshField field = square(1);
  field.values[3] = kNan;  // at (1, 1), a corner of the second triangle
  const MeshValues values = *MeshValues::make(field);
  EXPECT_NEAR(values.value({0.3, 0.3}), 0.7, 1e-15);
  EXPECT_TRUE(std::isnan(values.value({0.7, 0.7})));
  EXPECT_TRUE(std::isnan(values.slope({0.7, 0.7})));
  EXPECT_TRUE(std::isnan(values.value({2, 2})));
}

TEST(CheckersMeshField, OfTrianglesThatOverlapIsThatOfTheFirst) {
  MeshField field{
      {{0, 0}, {1, 0}, {0, 1}, {0, 0}, {1, 0}, {0, 1}}, {{3, 4, 5}, {0, 1, 2}}, {1, 1, 1, 2, 2, 2}};
  EXPECT_EQ((*MeshValues::make(field)).value({0.25, 0.25}), 2);
  std::swap(field.triangles[0], field.triangles[1]);
  EXPECT_EQ((*MeshValues::make(field)).value({0.25, 0.25}), 1);
}

TEST(CheckersMeshField, LeavesFlatTrianglesOut) {
  const MeshField field{
      {{0, 0}, {1, 0}, {0, 1}, {2, 0}}, {{0, 1, 3}, {0, 0, 1}, {0, 1, 2}}, {5, 5, 5, kNan}};
  EXPECT_EQ((*MeshValues::make(field)).value({2, 0}), 5);
}

TEST(CheckersMeshField, OfNonsenseIsRefused) {
  EXPECT_EQ(error_of({}), "no triangle has an area");
  EXPECT_EQ(error_of({{{0, 0}, {1, 0}, {0, 1}}, {{0, 1, 3}}, {1, 1, 1}}),
            "triangle 0 has vertex 3 of 3");
  EXPECT_EQ(error_of({{{0, 0}, {1, 0}, {0, 1}}, {{0, 1, 2}}, {1, 1}}), "2 values at 3 vertices");
  EXPECT_EQ(error_of({{{0, 0}, {1, kNan}, {0, 1}}, {{0, 1, 2}}, {1, 1, 1}}),
            "vertex 1 is (1, nan)");
  EXPECT_EQ(error_of({{{0, 0}, {1, 0}, {2, 0}}, {{0, 1, 2}}, {1, 1, 1}}),
            "no triangle has an area");
}

}  // namespace
}  // namespace weft::check
