// SPDX-License-Identifier: Apache-2.0
// Reads a domain from GeoJSON (RFC 7946): every geometry type, Feature, FeatureCollection,
// GeometryCollection. Coordinates are taken as they are (no projection; altitudes are dropped).
//
// What is meshed:
//   - With polygons: the points inside an odd number of rings (Fill::kEvenOdd), so rings of holes
//     are holes, and parts of a MultiPolygon that share an edge are both filled.
//   - Lines beside polygons become edges inside the domain. Each is sent twice, for two coincident
//     segments leave the parity of even-odd filling alone.
//   - Lines only: every bounded face (Fill::kSeeds).
//   - Points become vertices.
//
// Members of a Feature's `properties` that are numbers and mean something here:
//   marker    integer: marks the segments of the feature
//   region    integer: id of the triangles inside the feature's polygons
//   max_area  positive: bound on the area of these triangles
// A region floods from a point inside each polygon up to the nearest segments.
//
// Errors (kUnreadableInput) name the line and column where the text is not JSON, otherwise the path
// of the offender ("features[3].geometry.coordinates[0]"): wrong types, a ring that is not closed,
// has fewer than 3 distinct points or crosses itself, nesting deeper than 64 levels.
#pragma once

#include <filesystem>

#include "client/error.h"
#include "client/formats/domain.h"

namespace weft::client {

Result<Domain> read_geojson(const std::filesystem::path& path);

}  // namespace weft::client
