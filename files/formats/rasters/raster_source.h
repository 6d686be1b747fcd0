// SPDX-License-Identifier: Apache-2.0
// An open raster: where its nodes are, and the values of any part of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "files/base/error.h"
#include "files/formats/domain.h"
#include "files/formats/field_raster.h"

namespace weft::files {

struct RasterGrid {
  double x = 0;  // of the south-west node
  double y = 0;
  double dx = 1;  // > 0
  double dy = 1;
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;

  // With half a cell around the nodes.
  RasterBox extent() const {
    return {x - dx / 2, y - dy / 2, x + (columns - 0.5) * dx, y + (rows - 0.5) * dy};
  }
};

// Columns and rows of a grid, from the south-west. REQUIRES: inside the grid.
struct RasterPart {
  std::uint32_t column = 0;
  std::uint32_t row = 0;
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;
};

// From a plane to the coordinates of a raster.
class PlaneToRaster {
 public:
  virtual ~PlaneToRaster() = default;
  // In place, n points. NaN for a point that has no counterpart. Errors are at most `tolerance`, in
  // the raster's unit; points of a line, in order, cost less the larger it is.
  virtual void transform(std::size_t n, double* x, double* y, double tolerance) const = 0;
};

// What is known of a raster before a value is read.
struct RasterShape {
  std::string name;               // of file and band, for messages
  std::vector<RasterGrid> grids;  // the raster, then its overviews; all of about one extent
  std::string crs;                // name of its coordinate system; empty: it has none
  double turn = 0;                // x + turn is the same place as x; 0: there is no such number
};

class RasterSource {
 public:
  virtual ~RasterSource() = default;
  const RasterShape& shape() const { return shape_; }

  // Row i of the part, from the southmost, to out + i * stride.
  virtual Result<void> read(std::size_t grid, const RasterPart& part, float* out,
                            std::size_t stride) = 0;
  // Whether its coordinates are those of the system, or it has none, or both are longitudes and
  // latitudes.
  virtual bool is_in(const CoordinateSystem& system) const = 0;
  // If the raster has no coordinate system, it is taken for longitudes and latitudes of WGS 84.
  virtual Result<std::unique_ptr<PlaneToRaster>> from_plane(const std::string& crs) = 0;

 protected:
  RasterShape shape_;
};

// NaN for what is no finite float.
float field_value(double value);

// Whether the coordinates may be longitudes and latitudes in degrees.
bool looks_like_degrees(const RasterGrid& grid);

// By GDAL. Errors as in field_raster.h; without GDAL always one.
Result<std::unique_ptr<RasterSource>> open_with_gdal(const std::filesystem::path& path,
                                                     const std::string& band);

}  // namespace weft::files
