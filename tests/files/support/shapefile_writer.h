// SPDX-License-Identifier: Apache-2.0
// Writes a shapefile by Shapelib.
#pragma once

#include <filesystem>

namespace weft::files {

// BASE.shp, .shx and .dbf with two polygons: a square with a triangular hole, marker 3, region 7,
// max_area 0.5; and a triangle, marker 4, without the others.
void write_sample_shapefile(const std::filesystem::path& base);

// Two triangles: marker "coast" and region 5, "bay"; marker "island" without a region.
void write_named_shapefile(const std::filesystem::path& base);

// A triangle with fields of text: marker "3", region "7", max_area "0.1"; and a ring of 2 points.
void write_text_shapefile(const std::filesystem::path& base);

}  // namespace weft::files
