// SPDX-License-Identifier: Apache-2.0
#include "files/formats/meshes/geojson_mesh.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace weft::files {
namespace {

// A name as JSON. Names have no control characters.
std::string escaped(const std::string& name) {
  std::string out;
  for (const char c : name) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

}  // namespace

GeojsonMeshWriter::GeojsonMeshWriter(OutputFile& file) : file_(file) {
  file_.put(R"({"type":"FeatureCollection","features":[)");
}

void GeojsonMeshWriter::put_position(const MeshView& mesh, std::uint32_t vertex) {
  file_.put('[');
  file_.number(mesh.coordinates[2 * std::size_t{vertex}]);
  file_.put(',');
  file_.number(mesh.coordinates[2 * std::size_t{vertex} + 1]);
  file_.put(']');
}

void GeojsonMeshWriter::open_feature(std::string_view property, std::int32_t value,
                                     const NameTable& names, std::string_view geometry) {
  file_.put(first_ ? "\n" : ",\n");
  first_ = false;
  file_.put(R"({"type":"Feature","properties":{")");
  file_.put(property);
  file_.put("\":");
  file_.number(std::int64_t{value});
  if (const std::string* const name = name_of(names, value)) {
    file_.put(",\"");
    file_.put(property);
    file_.put("_name\":\"" + escaped(*name) + "\"");
  }
  file_.put(R"(},"geometry":{"type":")");
  file_.put(geometry);
  file_.put("\",\"coordinates\":[");
}

void GeojsonMeshWriter::put_triangles(const MeshView& piece) {
  for (const std::size_t t : piece.up_to(piece.triangle_count())) {
    open_feature("region", piece.regions.empty() ? 0 : piece.regions[t], piece.names->regions,
                 "Polygon");
    for (std::size_t k = 0; k < 4; ++k) {
      file_.put(k == 0 ? '[' : ',');
      put_position(piece, piece.triangles[3 * t + k % 3]);
    }
    file_.put("]]}}");
  }
}

void GeojsonMeshWriter::finish(const MeshView& mesh) {
  for (const std::size_t e : mesh.up_to(mesh.edge_count())) {
    open_feature("marker", mesh.edge_markers[e], mesh.names->markers, "LineString");
    put_position(mesh, mesh.edges[2 * e]);
    file_.put(',');
    put_position(mesh, mesh.edges[2 * e + 1]);
    file_.put("]}}");
  }
  file_.put("\n]}\n");
}

void write_geojson_mesh(const MeshView& mesh, OutputFile& file) {
  GeojsonMeshWriter writer(file);
  writer.put_triangles(mesh);
  writer.finish(mesh);
}

}  // namespace weft::files
