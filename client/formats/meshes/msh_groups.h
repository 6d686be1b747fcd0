// SPDX-License-Identifier: Apache-2.0
// Gmsh's physical groups: each region is one of dimension 2, each marker one of dimension 1. A
// group has the name of its region or marker; without one, it is named "region <id>" or "marker
// <value>". A group's tag is the id or value itself if that is positive, otherwise the lowest free
// number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "client/base/atomic_file.h"
#include "client/base/paged_memory.h"
#include "client/formats/mesh.h"

namespace weft::client {

struct PhysicalGroups {
  // `names` are those of regions or of markers, and outlive the groups.
  PhysicalGroups(PagedMemory* pages, std::span<const std::int32_t> values, const NameTable& names);
  // The index of a value in `ids`. REQUIRES: it is one of them.
  std::size_t find(std::int32_t value) const;

  std::vector<std::int32_t> ids;   // region ids or markers, ascending
  std::vector<std::int32_t> tags;  // of the group of each
  const NameTable& names;
};

// The section $PhysicalNames. A positive id that has a name, but no element, is there, too.
void put_physical_names(OutputFile& file, const PhysicalGroups& markers,
                        const PhysicalGroups& regions);

// A section $NodeData for each of the values at nodes, as `binary` says.
void put_node_data(OutputFile& file, const MeshView& mesh, bool binary);

// Gmsh's numbers for the kinds of elements, of a mesh of order 1 or 2.
constexpr std::int32_t msh_line_type(std::size_t order) {
  return order == 2 ? 8 : 1;
}
constexpr std::int32_t msh_triangle_type(std::size_t order) {
  return order == 2 ? 9 : 2;
}

}  // namespace weft::client
