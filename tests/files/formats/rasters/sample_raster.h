// SPDX-License-Identifier: Apache-2.0
// Rasters for tests, written by GDAL.
#pragma once

#include <gdal.h>

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace weft::files {

struct SampleRaster {
  int columns = 1;
  int rows = 1;
  // As of GDAL: a pixel's corner (c, r) is at (t[0] + c t[1] + r t[2], t[3] + c t[4] + r t[5]).
  std::optional<std::array<double, 6>> transform{};
  // Of the centre of a pixel; band i has it plus 1000 * (i - 1).
  std::function<double(double x, double y)> value{};
  std::string crs = "EPSG:4326";  // or empty
  GDALDataType type = GDT_Float64;
  std::optional<double> nodata{};
  std::optional<double> scale{}, offset{};  // stated, not applied
  std::vector<std::string> bands{""};       // names; "alpha" is no data
  // False: no data. Told by the band "alpha", or by a mask beside the bands.
  std::function<bool(double x, double y)> mask{};
};

// Through memory to a file of the driver. REQUIRES: the driver can.
void write_raster(const std::filesystem::path& path, const char* driver,
                  const SampleRaster& sample);

}  // namespace weft::files
