// SPDX-License-Identifier: Apache-2.0
// What of a raster a box needs: see read_field_raster.
#pragma once

#include <cstdint>

#include "files/base/error.h"
#include "files/formats/rasters/raster_source.h"

namespace weft::files {

Result<FieldRaster> read_window(RasterSource& source, const RasterBox& box,
                                std::uint64_t max_values);

}  // namespace weft::files
