// SPDX-License-Identifier: Apache-2.0
// What of a raster a box in another plane needs: see read_field_raster_projected.
#pragma once

#include <cstdint>
#include <string>

#include "files/base/error.h"
#include "files/formats/rasters/raster_source.h"

namespace weft::files {

Result<FieldRaster> read_projected_window(RasterSource& source, const RasterBox& box,
                                          const std::string& crs, std::uint64_t max_values);

}  // namespace weft::files
