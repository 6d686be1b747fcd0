// SPDX-License-Identifier: Apache-2.0
// A mesh as GeoJSON (RFC 7946), for geographic information systems: a FeatureCollection with a
// Polygon for every triangle, property `region`, then a LineString for every edge on an input
// segment, property `marker`. Coordinates are written as they are. Shared vertices are repeated;
// the mesh cannot be read back from it. Nothing at the head depends on the end, so the triangles
// may be written while the mesh arrives.
#pragma once

#include <cstdint>
#include <string_view>

#include "files/base/atomic_file.h"
#include "files/formats/mesh.h"

namespace weft::files {

// Writes a mesh in pieces: the same bytes, however it is cut.
class GeojsonMeshWriter {
 public:
  // `file` outlives this.
  explicit GeojsonMeshWriter(OutputFile& file);
  // The triangles of the next piece. It has the coordinates of all vertices so far; its regions are
  // empty if all are 0.
  void put_triangles(const MeshView& piece);
  // The edges of the whole mesh. Nothing is written after that.
  void finish(const MeshView& mesh);

 private:
  void open_feature(std::string_view property, std::int32_t value, const NameTable& names,
                    std::string_view geometry);
  void put_position(const MeshView& mesh, std::uint32_t vertex);

  OutputFile& file_;
  bool first_ = true;
};

void write_geojson_mesh(const MeshView& mesh, OutputFile& file);

}  // namespace weft::files
