// SPDX-License-Identifier: Apache-2.0
// A mesh as GeoJSON (RFC 7946), for geographic information systems: a FeatureCollection with a
// Polygon for every triangle, property `region`, then a LineString for every edge on an input
// segment, property `marker`. Coordinates are written as they are. Shared vertices are repeated;
// the mesh cannot be read back from it.
#pragma once

#include "files/base/atomic_file.h"
#include "files/formats/mesh.h"

namespace weft::files {

void write_geojson_mesh(const MeshView& mesh, OutputFile& file);

}  // namespace weft::files
