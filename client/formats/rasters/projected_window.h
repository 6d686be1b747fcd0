// SPDX-License-Identifier: Apache-2.0
// What of a raster a box in another plane needs: see read_field_raster_projected.
#pragma once

#include <cstdint>
#include <string>

#include "client/base/error.h"
#include "client/formats/rasters/raster_source.h"

namespace weft::client {

Result<FieldRaster> read_projected_window(RasterSource& source, const RasterBox& box,
                                          const std::string& crs, std::uint64_t max_values);

}  // namespace weft::client
