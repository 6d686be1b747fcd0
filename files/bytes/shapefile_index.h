// SPDX-License-Identifier: Apache-2.0
// The .shx file of a shapefile, which holds where its records are.
#pragma once

#include <string>
#include <string_view>

namespace weft::files {

// Made of the .shp file, whose records follow one another; empty if that is no shapefile. Records
// that reach beyond the file's end, and what follows them, are not in it.
std::string index_of_shapes(std::string_view shp);

}  // namespace weft::files
