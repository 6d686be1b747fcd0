// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "files/formats/meshes/msh.h"
#include "files/formats/meshes/msh_groups.h"

namespace weft::files {
namespace {

// Items 0 to n - 1, sorted by their entity, then by number.
class ByEntity {
 public:
  // entity_of(i) is below `entities`; it is called twice for every i, in order.
  template <class EntityOf>
  ByEntity(const MeshView& mesh, std::size_t entities, std::size_t count, EntityOf&& entity_of)
      : starts_(entities + 1, 0) {
    if (entities <= 1) {  // they are sorted already
      starts_.back() = entities * count;
      return;
    }
    for (const std::size_t i : mesh.up_to(count)) ++starts_[entity_of(i) + 1];
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
    order_ = ScratchArray<std::uint32_t>(mesh.pages, count);
    for (const std::size_t i : mesh.up_to(count))
      order_[next[entity_of(i)]++] = static_cast<std::uint32_t>(i);
  }

  std::size_t size() const { return starts_.back(); }
  std::size_t size(std::size_t entity) const { return starts_[entity + 1] - starts_[entity]; }
  // Calls each(i) for the items of one entity.
  template <class Each>
  void for_each(const MeshView& mesh, std::size_t entity, Each&& each) const {
    const std::size_t first = starts_[entity];
    for (const std::size_t i : mesh.up_to(size(entity)))
      each(order_.size() == 0 ? first + i : std::size_t{order_[first + i]});
  }

 private:
  std::vector<std::size_t> starts_;    // of each entity; one more at the end
  ScratchArray<std::uint32_t> order_;  // empty if they are sorted already
};

// The entity of each value. Equal values come in long runs, so the last one is remembered.
class EntityOf {
 public:
  EntityOf(const LabelTags& groups, std::span<const std::int32_t> values)
      : groups_(groups), values_(values) {}
  std::size_t operator()(std::size_t i) {
    if (!is_found_ || values_[i] != value_) {
      value_ = values_[i];
      entity_ = groups_.find(value_);
      is_found_ = true;
    }
    return entity_;
  }

 private:
  const LabelTags& groups_;
  std::span<const std::int32_t> values_;
  bool is_found_ = false;
  std::int32_t value_ = 0;
  std::size_t entity_ = 0;
};

// The elements of one dimension. Entity e has the tag e + 1 and is the one of its physical group.
struct Groups : LabelTags {
  Groups(const MeshView& mesh, std::span<const std::int32_t> of_elements, const NameTable& table)
      : LabelTags(mesh.pages, of_elements, table),
        values(of_elements),
        elements(mesh, ids.size(), values.size(), EntityOf(*this, values)) {}
  EntityOf entity_of() const { return {*this, values}; }

  std::span<const std::int32_t> values;
  ByEntity elements;
};

// The corners and the physical group of each entity, without the entities that bound it.
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
      groups.elements.for_each(mesh, e, [&](std::size_t i) {
        for (std::size_t k = 0; k < nodes; ++k) {
          const std::size_t v = vertices[i * nodes + k];
          for (std::size_t axis = 0; axis < 2; ++axis) {
            const double c = mesh.coordinates[2 * v + axis];
            low[axis] = empty ? c : std::min(low[axis], c);
            high[axis] = empty ? c : std::max(high[axis], c);
          }
          empty = false;
        }
      });
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
  // Entities are curves, then surfaces. A node belongs to the first edge at it, or else to the
  // first triangle, or else to entity 0.
  const std::size_t entities = curves.ids.size() + surfaces.ids.size();
  ScratchArray<std::uint32_t> entity_of(mesh.pages, mesh.vertex_count());  // plus 1; 0: of none
  const auto claim = [&mesh, &entity_of](std::span<const std::uint32_t> nodes, std::size_t each,
                                         std::size_t first, EntityOf entity) {
    for (const std::size_t i : mesh.up_to(nodes.size()))
      if (std::uint32_t& of = entity_of[nodes[i]]; of == 0)
        of = static_cast<std::uint32_t>(first + entity(i / each) + 1);
  };
  claim(mesh.edges, mesh.edge_nodes(), 0, curves.entity_of());
  claim(mesh.triangles, mesh.triangle_nodes(), curves.ids.size(), surfaces.entity_of());
  const ByEntity nodes(mesh, entities, mesh.vertex_count(), [&entity_of](std::size_t v) {
    return std::max<std::size_t>(entity_of[v], 1) - 1;
  });

  file.put("$Nodes\n");
  const std::uint64_t count = nodes.size();
  for (const std::uint64_t value : {std::uint64_t{entities}, count, std::uint64_t{1}, count})
    file.put_raw(value);
  for (std::size_t e = 0; e < entities; ++e) {
    const bool curve = e < curves.ids.size();
    file.put_raw(std::int32_t{curve ? 1 : 2});
    file.put_raw(static_cast<std::int32_t>(curve ? e + 1 : e - curves.ids.size() + 1));
    file.put_raw(std::int32_t{0});
    file.put_raw(std::uint64_t{nodes.size(e)});
    nodes.for_each(mesh, e, [&file](std::size_t v) { file.put_raw(std::uint64_t{v} + 1); });
    nodes.for_each(mesh, e, [&](std::size_t v) {
      const double at[] = {mesh.coordinates[2 * v], mesh.coordinates[2 * v + 1], 0.0};
      file.put_array(std::span<const double>(at));
    });
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
  const auto put = [&](const Groups& groups, std::span<const std::uint32_t> vertices,
                       std::int32_t dimension, std::int32_t type, std::size_t nodes) {
    std::uint64_t element[7];
    for (std::size_t e = 0; e < groups.ids.size(); ++e) {
      file.put_raw(dimension);
      file.put_raw(static_cast<std::int32_t>(e + 1));
      file.put_raw(type);
      file.put_raw(std::uint64_t{groups.elements.size(e)});
      groups.elements.for_each(mesh, e, [&](std::size_t i) {
        element[0] = ++tag;
        for (std::size_t k = 0; k < nodes; ++k)
          element[k + 1] = std::uint64_t{vertices[i * nodes + k]} + 1;
        file.put_array(std::span<const std::uint64_t>(element).first(nodes + 1));
      });
    }
  };
  put(curves, mesh.edges, 1, msh_line_type(mesh.order), mesh.edge_nodes());
  put(surfaces, mesh.triangles, 2, msh_triangle_type(mesh.order), mesh.triangle_nodes());
  file.put("\n$EndElements\n");
}

void put_periodic(OutputFile& file, const Groups& curves, std::span<const PeriodicNodes> periodic) {
  if (periodic.empty()) return;
  file.put("$Periodic\n");
  file.put_raw(std::uint64_t{periodic.size()});
  for (const PeriodicNodes& nodes : periodic) {
    file.put_raw(std::int32_t{1});
    for (const std::int32_t marker : {nodes.markers[1], nodes.markers[0]})
      file.put_raw(static_cast<std::int32_t>(curves.find(marker) + 1));
    // By rows, of homogeneous coordinates.
    const double c = nodes.cosine, s = nodes.sine;
    const std::array<double, 16> motion{c, -s, 0, nodes.dx, s, c, 0, nodes.dy,
                                        0, 0,  1, 0,        0, 0, 0, 1};
    file.put_raw(std::uint64_t{motion.size()});
    file.put_array(std::span<const double>(motion));
    file.put_raw(std::uint64_t{nodes.pairs.size()});
    for (const auto& [first, second] : nodes.pairs) {
      file.put_raw(std::uint64_t{second} + 1);
      file.put_raw(std::uint64_t{first} + 1);
    }
  }
  file.put("\n$EndPeriodic\n");
}

}  // namespace

void write_msh(const MeshView& mesh, std::span<const PeriodicNodes> periodic, OutputFile& file) {
  const Groups curves(mesh, mesh.edge_markers, mesh.names->markers);
  const Groups surfaces(mesh, mesh.regions, mesh.names->regions);
  file.put("$MeshFormat\n4.1 1 8\n");
  file.put_raw(std::int32_t{1});  // shows the byte order
  file.put("\n$EndMeshFormat\n");
  put_physical_names(file, curves, surfaces);
  put_entities(file, mesh, curves, surfaces);
  put_nodes(file, mesh, curves, surfaces);
  put_elements(file, mesh, curves, surfaces);
  put_periodic(file, curves, periodic);
  put_node_data(file, mesh, /*binary=*/true);
}

}  // namespace weft::files
