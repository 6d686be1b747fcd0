// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <span>
#include <string>

#include "client/formats/msh.h"
#include "client/formats/msh_groups.h"
#include "client/formats/text_writer.h"

namespace weft::client {
namespace {

// Elements have a number, a type, two tags (physical group, entity) and their nodes.
void put_elements(OutputFile& file, std::span<const std::uint32_t> nodes, std::size_t per_element,
                  std::span<const std::int32_t> values, const PhysicalGroups& groups,
                  std::int32_t type, std::int64_t& number) {
  std::string middle;  // all but the number and the nodes
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i == 0 || values[i] != values[i - 1]) {
      const std::size_t entity = groups.find(values[i]);
      middle = " " + std::to_string(type) + " 2 " + std::to_string(groups.tags[entity]) + " " +
               std::to_string(entity + 1);
    }
    file.number(++number);
    file.put(middle);
    for (std::size_t k = 0; k < per_element; ++k) {
      file.put(' ');
      file.number(nodes[i * per_element + k] + std::int64_t{1});
    }
    file.put('\n');
  }
}

}  // namespace

void write_msh22(const MeshView& mesh, OutputFile& file) {
  const PhysicalGroups markers(mesh.edge_markers);
  const PhysicalGroups regions(mesh.regions);
  file.put("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
  put_physical_names(file, markers, regions);
  file.put("$Nodes\n");
  put_line(file, mesh.vertex_count());
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    put_line(file, v + 1, mesh.coordinates[2 * v], mesh.coordinates[2 * v + 1], 0);
  file.put("$EndNodes\n$Elements\n");
  put_line(file, mesh.edge_count() + mesh.triangle_count());
  std::int64_t number = 0;
  put_elements(file, mesh.edges, mesh.edge_nodes(), mesh.edge_markers, markers,
               msh_line_type(mesh.order), number);
  put_elements(file, mesh.triangles, mesh.triangle_nodes(), mesh.regions, regions,
               msh_triangle_type(mesh.order), number);
  file.put("$EndElements\n");
}

}  // namespace weft::client
