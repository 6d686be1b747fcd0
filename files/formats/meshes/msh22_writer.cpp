// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <span>
#include <string>

#include "files/bytes/text_writer.h"
#include "files/formats/meshes/msh.h"
#include "files/formats/meshes/msh_groups.h"

namespace weft::files {
namespace {

// Elements have a number, a type, two tags (physical group, entity) and their nodes.
void put_elements(OutputFile& file, const MeshView& mesh, std::span<const std::uint32_t> nodes,
                  std::size_t per_element, std::span<const std::int32_t> values,
                  const LabelTags& groups, std::int32_t type, std::int64_t& number) {
  std::string middle;  // all but the number and the nodes
  for (const std::size_t i : mesh.up_to(values.size())) {
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

void put_periodic(OutputFile& file, const LabelTags& markers,
                  std::span<const PeriodicNodes> periodic) {
  if (periodic.empty()) return;
  file.put("$Periodic\n");
  put_line(file, periodic.size());
  for (const PeriodicNodes& nodes : periodic) {
    put_line(file, 1, markers.find(nodes.markers[1]) + 1, markers.find(nodes.markers[0]) + 1);
    put_line(file, nodes.pairs.size());
    for (const auto& [first, second] : nodes.pairs)
      put_line(file, second + std::int64_t{1}, first + std::int64_t{1});
  }
  file.put("$EndPeriodic\n");
}

}  // namespace

void write_msh22(const MeshView& mesh, std::span<const PeriodicNodes> periodic, OutputFile& file) {
  const LabelTags markers(mesh.pages, mesh.edge_markers, mesh.names->markers);
  const LabelTags regions(mesh.pages, mesh.regions, mesh.names->regions);
  file.put("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
  put_physical_names(file, markers, regions);
  file.put("$Nodes\n");
  put_line(file, mesh.vertex_count());
  for (const std::size_t v : mesh.up_to(mesh.vertex_count()))
    put_line(file, v + 1, mesh.coordinates[2 * v], mesh.coordinates[2 * v + 1], 0);
  file.put("$EndNodes\n$Elements\n");
  put_line(file, mesh.edge_count() + mesh.triangle_count());
  std::int64_t number = 0;
  put_elements(file, mesh, mesh.edges, mesh.edge_nodes(), mesh.edge_markers, markers,
               msh_line_type(mesh.order), number);
  put_elements(file, mesh, mesh.triangles, mesh.triangle_nodes(), mesh.regions, regions,
               msh_triangle_type(mesh.order), number);
  file.put("$EndElements\n");
  put_periodic(file, markers, periodic);
  put_node_data(file, mesh, /*binary=*/false);
}

}  // namespace weft::files
