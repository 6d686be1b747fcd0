// SPDX-License-Identifier: Apache-2.0
// Reads a domain by OGR, GDAL's half for vectors: polygons, lines and points of any dimension,
// whose heights and measures are dropped, and arcs, where a format has them by three points each
// (three_point_arcs.h). Curves that a driver of GDAL divides are chords of at most 4 degrees.
// Fields `marker`, `region`, `max_area` and `max_edge`, of numbers or of texts that are numbers,
// mean the same as in GeoJSON (geojson.h). What is meshed: see geometry_builder.h. Coordinates are
// taken as they are, longitude before latitude.
//
// Only the file and those that its format keeps beside it are opened, of a ZIP archive those in it
// (ogr_archive.h): no other format is tried, and nothing is fetched that a file names.
//
// Errors (kUnreadableInput) name the file, the layer and the feature: GDAL is missing; a layer that
// does not exist, or several of which none is named; a condition that is no SQL; layers in
// different coordinate systems; those of GeometryBuilder.
#pragma once

#include <filesystem>

#include "files/base/error.h"
#include "files/formats/domain_formats.h"
#include "files/formats/layer_options.h"

namespace weft::files {

// REQUIRES: `format`, that of the file, has layers.
Result<Domain> read_with_ogr(const DomainFormat& format, const std::filesystem::path& path,
                             const LayerOptions& options);

// Whether coordinates mean the same place in both, but for the datum of longitudes and latitudes.
bool are_same(const CoordinateSystem& a, const CoordinateSystem& b);

}  // namespace weft::files
