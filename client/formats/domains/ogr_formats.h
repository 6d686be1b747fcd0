// SPDX-License-Identifier: Apache-2.0
// The vector formats that weft reads by OGR.
#pragma once

#include <span>
#include <string_view>

namespace weft::client {

struct OgrFormat {
  std::string_view extension;  // lower case, ".gpkg"
  // For GDALOpenEx, each a list that ends in null: the drivers that may read it, and how they open
  // it. Null of an archive.
  const char* const* drivers;
  const char* const* options = nullptr;
  // Whether weft has a reader of its own, which is used unless layers or features are chosen.
  bool own_reader = false;
  bool is_archive = false;  // of files in other formats: ogr_archive.h
};

// The format of an extension, in lower case; null if there is none.
const OgrFormat* ogr_format(std::string_view extension);

std::span<const OgrFormat> ogr_formats();

}  // namespace weft::client
