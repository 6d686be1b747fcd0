// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "client/formats/msh.h"
#include "client/formats/msh_groups.h"

namespace weft::client {
namespace {

// The elements of one dimension, sorted by entity. Entity e has the tag e + 1 and is the one of its
// physical group.
struct Groups : PhysicalGroups {
  using PhysicalGroups::PhysicalGroups;
  std::vector<std::uint32_t> entity_of;  // per element
  std::vector<std::uint32_t> order;      // elements by entity, then by number
  std::vector<std::size_t> starts;       // per entity: its first in `order`; one more at the end
};

// Orders 0 .. entity_of.size() - 1 by entity, stably.
void sort_by_entity(std::size_t entities, const std::vector<std::uint32_t>& entity_of,
                    std::vector<std::uint32_t>& order, std::vector<std::size_t>& starts) {
  starts.assign(entities + 1, 0);
  for (const std::uint32_t e : entity_of) ++starts[e + 1];
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<std::size_t> next(starts.begin(), starts.end() - 1);
  order.resize(entity_of.size());
  for (std::uint32_t i = 0; i < entity_of.size(); ++i) order[next[entity_of[i]]++] = i;
}

Groups group(std::span<const std::int32_t> values) {
  Groups groups(values);
  groups.entity_of.resize(values.size());
  std::uint32_t entity = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i == 0 || values[i] != values[i - 1])
      entity = static_cast<std::uint32_t>(groups.find(values[i]));
    groups.entity_of[i] = entity;
  }
  sort_by_entity(groups.ids.size(), groups.entity_of, groups.order, groups.starts);
  return groups;
}

// Corners and physical group of each entity; nothing of what bounds it.
void put_entities(OutputFile& file, const MeshView& mesh, const Groups& curves,
                  const Groups& surfaces) {
  file.put("$Entities\n");
  for (const std::uint64_t count : {std::uint64_t{0}, std::uint64_t{curves.ids.size()},
                                    std::uint64_t{surfaces.ids.size()}, std::uint64_t{0}})
    file.put_raw(count);
  const auto put = [&file, &mesh](const Groups& groups, std::span<const std::uint32_t> vertices,
                                  std::size_t nodes) {
    for (std::size_t e = 0; e < groups.ids.size(); ++e) {
      double low[3] = {};
      double high[3] = {};
      bool empty = true;
      for (std::size_t i = groups.starts[e]; i < groups.starts[e + 1]; ++i) {
        for (std::size_t k = 0; k < nodes; ++k) {
          const std::size_t v = vertices[groups.order[i] * nodes + k];
          for (std::size_t axis = 0; axis < 2; ++axis) {
            const double c = mesh.coordinates[2 * v + axis];
            low[axis] = empty ? c : std::min(low[axis], c);
            high[axis] = empty ? c : std::max(high[axis], c);
          }
          empty = false;
        }
      }
      file.put_raw(static_cast<std::int32_t>(e + 1));
      file.put_array(std::span<const double>(low));
      file.put_array(std::span<const double>(high));
      file.put_raw(std::uint64_t{1});
      file.put_raw(groups.tags[e]);
      file.put_raw(std::uint64_t{0});
    }
  };
  put(curves, mesh.edges, mesh.edge_nodes());
  put(surfaces, mesh.triangles, mesh.triangle_nodes());
  file.put("\n$EndEntities\n");
}

void put_nodes(OutputFile& file, const MeshView& mesh, const Groups& curves,
               const Groups& surfaces) {
  // Entities are curves, then surfaces. Later writes win: an edge claims its ends from triangles.
  const std::size_t entities = curves.ids.size() + surfaces.ids.size();
  std::vector<std::uint32_t> entity_of(entities == 0 ? 0 : mesh.vertex_count(), 0);
  for (std::size_t i = mesh.triangles.size(); i-- > 0;)
    entity_of[mesh.triangles[i]] = static_cast<std::uint32_t>(
        curves.ids.size() + surfaces.entity_of[i / mesh.triangle_nodes()]);
  for (std::size_t i = mesh.edges.size(); i-- > 0;)
    entity_of[mesh.edges[i]] = curves.entity_of[i / mesh.edge_nodes()];
  std::vector<std::uint32_t> order;
  std::vector<std::size_t> starts;
  sort_by_entity(entities, entity_of, order, starts);

  file.put("$Nodes\n");
  const std::uint64_t count = order.size();
  for (const std::uint64_t value : {std::uint64_t{entities}, count, std::uint64_t{1}, count})
    file.put_raw(value);
  for (std::size_t e = 0; e < entities; ++e) {
    const bool curve = e < curves.ids.size();
    file.put_raw(std::int32_t{curve ? 1 : 2});
    file.put_raw(static_cast<std::int32_t>(curve ? e + 1 : e - curves.ids.size() + 1));
    file.put_raw(std::int32_t{0});
    file.put_raw(std::uint64_t{starts[e + 1] - starts[e]});
    for (std::size_t i = starts[e]; i < starts[e + 1]; ++i)
      file.put_raw(std::uint64_t{order[i]} + 1);
    for (std::size_t i = starts[e]; i < starts[e + 1]; ++i) {
      const double at[] = {mesh.coordinates[2 * std::size_t{order[i]}],
                           mesh.coordinates[2 * std::size_t{order[i]} + 1], 0.0};
      file.put_array(std::span<const double>(at));
    }
  }
  file.put("\n$EndNodes\n");
}

void put_elements(OutputFile& file, const MeshView& mesh, const Groups& curves,
                  const Groups& surfaces) {
  file.put("$Elements\n");
  const std::uint64_t count = mesh.triangle_count() + mesh.edge_count();
  for (const std::uint64_t value :
       {std::uint64_t{curves.ids.size() + surfaces.ids.size()}, count, std::uint64_t{1}, count})
    file.put_raw(value);
  std::uint64_t tag = 0;
  const auto put = [&file, &tag](const Groups& groups, std::span<const std::uint32_t> vertices,
                                 std::int32_t dimension, std::int32_t type, std::size_t nodes) {
    std::uint64_t element[7];
    for (std::size_t e = 0; e < groups.ids.size(); ++e) {
      file.put_raw(dimension);
      file.put_raw(static_cast<std::int32_t>(e + 1));
      file.put_raw(type);
      file.put_raw(std::uint64_t{groups.starts[e + 1] - groups.starts[e]});
      for (std::size_t i = groups.starts[e]; i < groups.starts[e + 1]; ++i) {
        element[0] = ++tag;
        for (std::size_t k = 0; k < nodes; ++k)
          element[k + 1] = std::uint64_t{vertices[groups.order[i] * nodes + k]} + 1;
        file.put_array(std::span<const std::uint64_t>(element).first(nodes + 1));
      }
    }
  };
  put(curves, mesh.edges, 1, msh_line_type(mesh.order), mesh.edge_nodes());
  put(surfaces, mesh.triangles, 2, msh_triangle_type(mesh.order), mesh.triangle_nodes());
  file.put("\n$EndElements\n");
}

}  // namespace

void write_msh(const MeshView& mesh, OutputFile& file) {
  const Groups curves = group(mesh.edge_markers);
  const Groups surfaces = group(mesh.regions);
  file.put("$MeshFormat\n4.1 1 8\n");
  file.put_raw(std::int32_t{1});  // tells the byte order
  file.put("\n$EndMeshFormat\n");
  put_physical_names(file, curves, surfaces);
  put_entities(file, mesh, curves, surfaces);
  put_nodes(file, mesh, curves, surfaces);
  put_elements(file, mesh, curves, surfaces);
}

}  // namespace weft::client
