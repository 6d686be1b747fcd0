// SPDX-License-Identifier: Apache-2.0
// Gmsh's physical groups: each region is one of dimension 2, each marker one of dimension 1. A
// group has the name of its region or marker; without one, it is named "region <id>" or "marker
// <value>". Its tag is that of label_tags.h.
#pragma once

#include <cstddef>
#include <cstdint>

#include "files/base/atomic_file.h"
#include "files/formats/derived/label_tags.h"
#include "files/formats/mesh.h"

namespace weft::files {

// The section $PhysicalNames. A positive id that has a name, but no element, is there, too.
void put_physical_names(OutputFile& file, const LabelTags& markers, const LabelTags& regions);

// A section $NodeData for each of the values at nodes, as `binary` says.
void put_node_data(OutputFile& file, const MeshView& mesh, bool binary);

// Gmsh's numbers for the kinds of elements, of a mesh of order 1 or 2.
constexpr std::int32_t msh_line_type(std::size_t order) {
  return order == 2 ? 8 : 1;
}
constexpr std::int32_t msh_triangle_type(std::size_t order) {
  return order == 2 ? 9 : 2;
}

}  // namespace weft::files
