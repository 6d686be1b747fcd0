// SPDX-License-Identifier: Apache-2.0
// Rasters in a folder, for tests of what is read of them.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "files/formats/field_raster.h"
#include "tests/files/formats/rasters/sample_raster.h"
#include "tests/files/support/temp_folder.h"

namespace weft::files {

inline double plane(double x, double y) {
  return 2 * x + 3 * y;
}

class FieldRasterFile : public ::testing::Test {
 protected:
  std::filesystem::path write(const SampleRaster& sample, const char* name = "r.tif",
                              const char* driver = "GTiff") {
    write_raster(folder_ / name, driver, sample);
    return folder_ / name;
  }
  // What is said of a raster that must be refused, less the folder.
  std::string refusal(const Result<FieldRaster>& raster) {
    if (raster) return "it was read";
    EXPECT_EQ(raster.error().exit, ExitCode::kUnreadableInput);
    std::string text = raster.error().message;
    for (std::size_t at = 0; (at = text.find(folder_.path().string())) != std::string::npos;)
      text.erase(at, folder_.path().string().size() + 1);
    return text;
  }
  TempFolder folder_;
};

// Every node has the value there, to the precision of a float.
inline void expect_values(const FieldRaster& raster, double (*value)(double, double)) {
  ASSERT_EQ(raster.values.size(), std::size_t{raster.columns} * raster.rows);
  for (std::size_t row = 0; row < raster.rows; ++row)
    for (std::size_t column = 0; column < raster.columns; ++column) {
      const double x = raster.x + static_cast<double>(column) * raster.dx;
      const double y = raster.y + static_cast<double>(row) * raster.dy;
      ASSERT_NEAR(raster.values[row * raster.columns + column], value(x, y), 1e-3)
          << "at " << x << ", " << y;
    }
}

inline void expect_grid(const FieldRaster& raster, double x, double y, double dx, double dy,
                        std::uint32_t columns, std::uint32_t rows) {
  EXPECT_DOUBLE_EQ(raster.x, x);
  EXPECT_DOUBLE_EQ(raster.y, y);
  EXPECT_DOUBLE_EQ(raster.dx, dx);
  EXPECT_DOUBLE_EQ(raster.dy, dy);
  EXPECT_EQ(raster.columns, columns);
  EXPECT_EQ(raster.rows, rows);
}

#define ASSERT_READ(raster) ASSERT_TRUE(raster) << (raster).error().message

inline constexpr RasterBox kAll{-180, -90, 180, 90};

// The longitude from 0 to 360, times 100, and the latitude.
inline double of_globe(double x, double y) {
  return std::fmod(x + 720, 360) * 100 + y;
}
// A global raster of these, from longitude 0 or -180 on.
inline SampleRaster globe(double west) {
  return {.columns = 720,
          .rows = 360,
          .transform = {{west, 0.5, 0, 90, 0, -0.5}},
          .value = of_globe,
          .type = GDT_Float32};
}

}  // namespace weft::files
