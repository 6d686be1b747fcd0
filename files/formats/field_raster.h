// SPDX-License-Identifier: Apache-2.0
// A raster file as the field of a request: what of it the domain needs, at about its own
// resolution.
//
// Reads ESRI ASCII grids (.asc, raster.h) by itself, and every raster that GDAL knows (GeoTIFF,
// NetCDF, VRT, ...) by GDAL, which is loaded when the first of them is read: linked, it would add
// 80 libraries and some 80 ms to the start of every `weft`.
//
// Nodes are the centres of pixels; scale and offset of the band are applied; a pixel that the file
// calls nodata, masks or makes transparent is NaN, as is one that is no finite float.
//
//   Result<FieldRaster> depth = read_field_raster("gebco.nc", "elevation", {-75, 38, -72, 41});
//
// Errors (kUnreadableInput) name the file: missing or damaged; in a format that this weft cannot
// read; with several bands and none chosen, which lists them; with a band of complex numbers;
// without a place in the plane; rotated or sheared; apart from the box, with both boxes.
// Thread-safe.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "files/base/error.h"
#include "files/formats/domain.h"

namespace weft::files {

struct FieldRaster {
  double x = 0;  // of the first node: the south-west one
  double y = 0;
  double dx = 1;  // > 0
  double dy = 1;
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;
  std::vector<float> values{};          // by rows, from the southmost; NaN where there is no data
  std::vector<std::string> warnings{};  // sentences for the user, which name the file
};

// REQUIRES: finite, minimum <= maximum.
struct RasterBox {
  double min_x = 0;
  double min_y = 0;
  double max_x = 0;
  double max_y = 0;
};

inline constexpr std::uint64_t kMaxFieldValues = std::uint64_t{16} << 20;

// The nodes in the box, and two more on each side if the raster has them.
//
// `band` is the number of a band, from 1, or its name; of a file of several variables, such as
// NetCDF, the name or the number of one, and `name:number` one band of it. Empty: the only one.
//
// A box with more than `max_values` nodes is read at the resolution of one of the raster's
// overviews, or by means over squares of pixels, whichever keeps more; a warning has both
// resolutions. Memory: some 200 MB beside the values, whatever the size of the file.
//
// Longitudes are modulo 360 degrees: the raster is shifted to the box, and continues over its seam
// if it goes round the globe. Without a coordinate system they are taken for longitudes if the
// raster goes round, or meets the box so alone; a warning says the latter.
Result<FieldRaster> read_field_raster(const std::filesystem::path& path, const std::string& band,
                                      const RasterBox& box,
                                      std::uint64_t max_values = kMaxFieldValues);

// The same for a box in `system`: as it is if the raster is in it (raster_source.h), else as
// read_field_raster_projected.
Result<FieldRaster> read_field_raster_in(const std::filesystem::path& path, const std::string& band,
                                         const RasterBox& box, const CoordinateSystem& system,
                                         std::uint64_t max_values = kMaxFieldValues);

// The same for a box in the plane of the coordinate system `crs`, as WKT, a PROJ string or a code
// such as "EPSG:32618": square cells of about the raster's own resolution, and the bilinear value
// of the raster at each node, of the pixels with data; NaN if the nearest has none, or is two
// pixels away. Poles and the date line may lie in the box. A raster without a coordinate system is
// taken for EPSG:4326, with a warning, if its coordinates look like degrees; else it is an error.
// Needs GDAL for every format.
Result<FieldRaster> read_field_raster_projected(const std::filesystem::path& path,
                                                const std::string& band, const RasterBox& box,
                                                const std::string& crs,
                                                std::uint64_t max_values = kMaxFieldValues);

// The same of an ESRI ASCII grid, whatever its file is called, and without GDAL: of a box in the
// plane of the grid, or, if there is a `to_degrees`, of one in the plane from which that leads to
// longitudes and latitudes, which those of the grid are then. What it gives may be NaN.
Result<FieldRaster> read_ascii_field(const std::filesystem::path& path, const RasterBox& box,
                                     const std::function<Point(Point)>& to_degrees,
                                     std::uint64_t max_values = kMaxFieldValues);

// Succeeds if there is such a file, or the path is one inside an archive, "/vsi..."; GDAL takes
// other words for the addresses of servers and data bases. Errors as above.
Result<void> must_be_raster_file(const std::filesystem::path& path);

// "FILE:BAND" as a file and a band: the file ends at the first colon before which there is one.
struct RasterPath {
  std::filesystem::path file;
  std::string band;

  friend bool operator==(const RasterPath&, const RasterPath&) = default;
};
RasterPath split_raster_path(std::string_view text);

}  // namespace weft::files
