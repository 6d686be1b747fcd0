// SPDX-License-Identifier: Apache-2.0
// Reads a domain from an ESRI shapefile, as Shapelib does: .shp and, if it is there, the .shx
// beside it; polygons, polylines, points and multipoints, whose altitudes and measures are dropped.
// Fields `marker`, `region`, `max_area` and `max_edge` of the .dbf beside it, if there is one, mean
// the same as in GeoJSON (geojson.h). What is meshed: see geometry_builder.h. Coordinates are taken
// as they are; a .prj beside it tells their system.
//
// Errors (kUnreadableInput) name the file and the record, counted from 0.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "files/base/error.h"
#include "files/formats/domain.h"

namespace weft::files {

Result<Domain> read_shapefile(const std::filesystem::path& path, bool lonlat = false);

// Its files in memory, by their extensions in lower case.
using ShapefileParts = std::map<std::string, std::string>;

// The same of files in memory; texts call them `path`. REQUIRES: there is a .shp.
Result<Domain> read_shapefile(ShapefileParts parts, const std::filesystem::path& path, bool lonlat);

}  // namespace weft::files
