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

void write_geojson_mesh(const MeshView& mesh, OutputFile& file) {
  const auto put_position = [&](std::uint32_t vertex) {
    file.put('[');
    file.number(mesh.coordinates[2 * std::size_t{vertex}]);
    file.put(',');
    file.number(mesh.coordinates[2 * std::size_t{vertex} + 1]);
    file.put(']');
  };
  bool first = true;
  const auto open_feature = [&](std::string_view property, std::int32_t value,
                                const NameTable& names, std::string_view geometry) {
    file.put(first ? "\n" : ",\n");
    first = false;
    file.put(R"({"type":"Feature","properties":{")");
    file.put(property);
    file.put("\":");
    file.number(std::int64_t{value});
    if (const std::string* const name = name_of(names, value)) {
      file.put(",\"");
      file.put(property);
      file.put("_name\":\"" + escaped(*name) + "\"");
    }
    file.put(R"(},"geometry":{"type":")");
    file.put(geometry);
    file.put("\",\"coordinates\":[");
  };
  file.put(R"({"type":"FeatureCollection","features":[)");
  for (const std::size_t t : mesh.up_to(mesh.triangle_count())) {
    open_feature("region", mesh.regions[t], mesh.names->regions, "Polygon");
    for (std::size_t k = 0; k < 4; ++k) {
      file.put(k == 0 ? '[' : ',');
      put_position(mesh.triangles[3 * t + k % 3]);
    }
    file.put("]]}}");
  }
  for (const std::size_t e : mesh.up_to(mesh.edge_count())) {
    open_feature("marker", mesh.edge_markers[e], mesh.names->markers, "LineString");
    put_position(mesh.edges[2 * e]);
    file.put(',');
    put_position(mesh.edges[2 * e + 1]);
    file.put("]}}");
  }
  file.put("\n]}\n");
}

}  // namespace weft::files
