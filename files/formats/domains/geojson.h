// SPDX-License-Identifier: Apache-2.0
// Reads a domain from GeoJSON (RFC 7946): every geometry type, Feature, FeatureCollection,
// GeometryCollection. Coordinates are taken as they are (no projection; altitudes are dropped).
//
// What is meshed: see geometry_builder.h.
//
// A member `crs`, of GeoJSON before RFC 7946, that names another system than WGS 84 is a warning.
//
// Members of a Feature's `properties` that are used:
//   marker       integer or text: marks the segments of the feature, or names their marker
//   region       integer or text: id of the triangles inside the feature's polygons, or its name
//   marker_name  text: what the integer `marker` is called; so is region_name for `region`
//   max_area     positive number: bound on the area of these triangles
//   max_edge     positive number: bound on the length of their edges, as --edge
//
// Errors (kUnreadableInput) name the line and column if the text is not JSON, otherwise the path
// of the offender ("features[3].geometry.coordinates[0]"): wrong types, nesting deeper than 64
// levels. What is left out or closed is a warning (geometry_builder.h).
#pragma once

#include <filesystem>

#include "files/base/error.h"
#include "files/formats/domain.h"

namespace weft::files {

Result<Domain> read_geojson(const std::filesystem::path& path, bool lonlat = false);

}  // namespace weft::files
