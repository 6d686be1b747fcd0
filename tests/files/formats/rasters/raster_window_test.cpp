// SPDX-License-Identifier: Apache-2.0
// Fields of ESRI ASCII grids, which need no GDAL. Those of GDAL: ../field_raster_test.cpp.
#include "files/formats/rasters/raster_window.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "files/formats/field_raster.h"
#include "tests/files/support/temp_folder.h"

namespace weft::files {
namespace {

class AsciiField : public ::testing::Test {
 protected:
  // A grid of so many columns and rows with corner (x, y), by rows from the northmost.
  std::filesystem::path write(int columns, int rows, double x, double y, double size,
                              const std::string& values) {
    return folder_.write("g.asc", "ncols " + std::to_string(columns) + "\nnrows " +
                                      std::to_string(rows) + "\nxllcorner " + std::to_string(x) +
                                      "\nyllcorner " + std::to_string(y) + "\ncellsize " +
                                      std::to_string(size) + "\nNODATA_value -9\n" + values + "\n");
  }
  TempFolder folder_;
};

TEST_F(AsciiField, MayHaveAnyValueAndNone) {
  const auto raster =
      read_field_raster(write(3, 2, 10, 20, 2, "-4 0 6\n1 -9 1e300"), "", {0, 0, 50, 50});
  ASSERT_TRUE(raster) << raster.error().message;
  EXPECT_EQ(raster->x, 11);
  EXPECT_EQ(raster->y, 21);
  EXPECT_EQ(raster->dx, 2);
  EXPECT_EQ(raster->columns, 3u);
  EXPECT_EQ(raster->rows, 2u);
  EXPECT_EQ(raster->values[0], 1);
  EXPECT_TRUE(std::isnan(raster->values[1]));
  EXPECT_TRUE(std::isnan(raster->values[2]));
  EXPECT_EQ((std::vector<float>{raster->values.begin() + 3, raster->values.end()}),
            (std::vector<float>{-4, 0, 6}));
}

TEST_F(AsciiField, HasOneBand) {
  const auto path = write(1, 1, 0, 0, 1, "3");
  EXPECT_TRUE(read_field_raster(path, "1", {0, 0, 1, 1}));
  const auto other = read_field_raster(path, "depth", {0, 0, 1, 1});
  ASSERT_FALSE(other);
  EXPECT_TRUE(other.error().message.ends_with("g.asc: has one band, not a band depth"));
}

TEST_F(AsciiField, IsCutAndAveraged) {
  std::string values;
  for (int row = 0; row < 40; ++row)
    for (int column = 0; column < 40; ++column)
      values += std::to_string(column + 100 * (39 - row)) + " ";
  const auto path = write(40, 40, 0, 0, 1, values);
  const auto cut = read_field_raster(path, "", {10, 20, 12, 22});
  ASSERT_TRUE(cut);
  EXPECT_EQ(cut->x, 8.5);
  EXPECT_EQ(cut->columns, 6u);
  EXPECT_EQ(cut->values[0], 8 + 100 * 18);
  const auto means = read_field_raster(path, "", {0, 0, 40, 40}, 400);
  ASSERT_TRUE(means);
  EXPECT_EQ(means->dx, 2);
  EXPECT_EQ(means->x, 1);
  EXPECT_EQ(means->columns, 20u);
  EXPECT_EQ(means->values[0], 50.5);
  EXPECT_EQ(means->values[21], 2.5 + 250);
  ASSERT_EQ(means->warnings.size(), 1u);
}

TEST_F(AsciiField, IsTakenForDegreesOnlyIfItMeetsTheBoxSo) {
  const auto path = write(2, 2, 284, 38, 1, "1 2 3 4");
  const auto shifted = read_field_raster(path, "", {-76, 38, -74, 40});
  ASSERT_TRUE(shifted) << shifted.error().message;
  EXPECT_EQ(shifted->x, -75.5);
  ASSERT_EQ(shifted->warnings.size(), 1u);
  EXPECT_NE(shifted->warnings[0].find("taken for longitudes, and shifted by -360"),
            std::string::npos);
  const auto plain = read_field_raster(path, "", {284, 38, 286, 40});
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->x, 284.5);
  EXPECT_TRUE(plain->warnings.empty());
  // These are no degrees.
  EXPECT_FALSE(read_field_raster(write(2, 2, 284, 380, 1, "1 2 3 4"), "", {-76, 380, -74, 382}));
}

// Straight between few points only where the line through the degrees is straight.
TEST_F(AsciiField, IsProjectedWhereItsDegreesBend) {
  std::string values;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 400; ++column) values += std::to_string(0.1 * column) + " ";
  const auto path = write(400, 3, -0.05, -0.05, 0.1, values);
  const auto degrees = [](double x) { return 20 + 15 * std::sin(x); };
  const auto field = read_ascii_field(
      path, {0, 0, 30, 0.1},
      [&](Point p) {
        return Point{degrees(p.x), p.y};
      },
      kMaxFieldValues);
  ASSERT_TRUE(field) << field.error().message;
  ASSERT_GT(field->columns, 100u);
  for (std::uint32_t i = 0; i < field->columns; ++i)
    EXPECT_NEAR(field->values[i], degrees(field->x + i * field->dx), 0.2) << i;
}

TEST_F(AsciiField, IsNamedBeforeTheColonOfABand) {
  const auto path = write(1, 1, 0, 0, 1, "3");
  const auto odd = folder_.write("a:b.nc", "");
  EXPECT_EQ(split_raster_path(path.string()).file, path);
  EXPECT_EQ(split_raster_path(path.string()).band, "");
  EXPECT_EQ(split_raster_path(path.string() + ":depth:3").file, path);
  EXPECT_EQ(split_raster_path(path.string() + ":depth:3").band, "depth:3");
  EXPECT_EQ(split_raster_path(odd.string() + ":2").file, odd);
  EXPECT_EQ(split_raster_path(odd.string() + ":2").band, "2");
  EXPECT_EQ(split_raster_path("none.tif:2").file, "none.tif:2");
}

}  // namespace
}  // namespace weft::files
