// SPDX-License-Identifier: Apache-2.0
// ADCIRC's grid file, fort.14 (https://adcirc.org/home/documentation, "ADCIRC Grid and Boundary
// Information File"): nodes with depths, triangles, open boundaries, land boundaries. SCHISM's .gr3
// (https://schism-dev.github.io/schism/master/input-output/hgrid.html) has the same lists.
//
// The boundary is cut into rings, and each ring where its marker changes. A piece is open if its
// marker is one of `open_boundaries`, otherwise it is mainland (IBTYPE 0); a ring around a hole
// without an open piece is an island (IBTYPE 1), in one piece. The domain lies to the left of the
// nodes of a boundary, so the land is on the right. As ADCIRC requires, a ring of one piece repeats
// its first node at the end if it is mainland, and not if it is open or an island. Markers of edges
// inside the domain are lost, and so are regions. Depths are those of the mesh's bed
// (bed.h), or 0.
//
// This folder has more than 25 files because each format has its own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "files/base/atomic_file.h"
#include "files/base/error.h"
#include "files/formats/derived/vertex_values.h"
#include "files/formats/mesh.h"

namespace weft::files {

void write_adcirc(const MeshView& mesh, std::span<const std::int32_t> open_boundaries,
                  OutputFile& file);

// Boundaries become edges, with the marker in the line of their count, as write_adcirc writes it
// ("= Number of nodes for open boundary 1, marker 3"); without it, 1 for open ones, 2 for
// mainland and all other kinds, 3 for islands. Depths are dropped.
Result<Mesh> read_adcirc(const std::filesystem::path& path);

// The same with the depths, as the array "depth".
Result<MeshWithArrays> read_adcirc_values(const std::filesystem::path& path,
                                          const std::optional<std::string>& wanted);

}  // namespace weft::files
