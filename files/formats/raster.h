// SPDX-License-Identifier: Apache-2.0
// Values on a grid, and the file that holds them: an ESRI ASCII grid (.asc), as GIS programs write
// rasters of one band.
//
//   ncols 3
//   nrows 2
//   xllcorner 10        (or xllcenter)
//   yllcorner 20        (or yllcenter)
//   cellsize 2          (or dx and dy)
//   NODATA_value -9999  (optional)
//   1 2 3               (the northmost row first)
//   4 5 6
//
// A value is that of the centre of its cell. Of a size it is the upper bound on the area of a
// triangle there, in squared units of the coordinates: every one must be positive, and a cell
// without a value is refused, because the bound there would be a guess. Of a field (field_raster.h)
// it is any number, and NaN if the cell has none.
//
//   Result<Raster> grid = read_raster("coast.asc");
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "files/base/atomic_file.h"
#include "files/base/error.h"

namespace weft::files {

struct Raster {
  double x = 0;  // of the first value: the south-west one
  double y = 0;
  double dx = 1;
  double dy = 1;
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;
  std::vector<double> values{};  // by rows, from the southmost
};

// Whether the path has the extension, in upper or lower case. No expression ends with it.
bool is_raster_path(const std::filesystem::path& path);

enum class RasterValues { kPositive, kAny };

// Errors (kUnreadableInput) name file, line and column.
Result<Raster> read_raster(const std::filesystem::path& path,
                           RasterValues wanted = RasterValues::kPositive);

// Cells without a value, NaN or infinite, have -9999. The failure of a write is the file's
// (OutputFile).
void write_raster(const Raster& grid, OutputFile& file);

}  // namespace weft::files
