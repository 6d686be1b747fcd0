// SPDX-License-Identifier: Apache-2.0
// Reads a domain from the only shapefile in a ZIP archive, in whatever folder there, as
// read_shapefile does: coastlines and boundaries are mostly published so. It is unpacked in memory.
//
// Errors (kUnreadableInput) name the archive: it is damaged, has no shapefile, or several; and
// those of read_shapefile.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "files/base/error.h"
#include "files/formats/domain.h"

namespace weft::files {

Result<Domain> read_zipped_shapefile(const std::filesystem::path& path, bool lonlat = false);

// Of the parts that would be unpacked; 0 if none would.
std::uint64_t zipped_shapefile_bytes(std::string_view archive);

}  // namespace weft::files
