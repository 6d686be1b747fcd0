// SPDX-License-Identifier: Apache-2.0
// Takes the place of gdal_source.cpp in a build without GDAL.
#include "files/formats/rasters/raster_source.h"

namespace weft::files {

Result<std::unique_ptr<RasterSource>> open_with_gdal(const std::filesystem::path& path,
                                                     const std::string&) {
  return fail(ExitCode::kUnreadableInput,
              path.string() + ": this weft was built without GDAL; of rasters it reads .asc alone");
}

}  // namespace weft::files
