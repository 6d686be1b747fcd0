// SPDX-License-Identifier: Apache-2.0
// Finds the files of a ZIP archive that are read as a domain. Boundaries and coastlines are mostly
// published as archives of shapefiles.
#pragma once

#include <filesystem>
#include <string>

#include "files/base/error.h"
#include "files/bytes/gdal_library.h"
#include "files/formats/domain_formats.h"

namespace weft::files {

// What GDAL opens.
struct OgrSource {
  std::string address;
  const DomainFormat* format;
};

// The only file of the archive at the absolute path that has layers, in whatever folder; or
// a folder of several shapefiles, each a layer. Errors (kUnreadableInput), which follow the name of
// the archive: it is damaged, has no such file, or several.
Result<OgrSource> find_in_archive(const Gdal& gdal, const std::string& path);

}  // namespace weft::files
