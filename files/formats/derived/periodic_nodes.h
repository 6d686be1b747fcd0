// SPDX-License-Identifier: Apache-2.0
// The nodes of two sides of a mesh that repeat each other, in pairs.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "files/formats/mesh.h"

namespace weft::files {

struct PeriodicNodes {
  std::array<std::int32_t, 2> markers;  // of the sides
  // The rotation and the translation that take the first side to the second: (x, y) to
  // (cosine x - sine y + dx, sine x + cosine y + dy).
  double cosine = 1;
  double sine = 0;
  double dx = 0;
  double dy = 0;
  // A node of the first side and its image on the second, ascending by the first.
  std::vector<std::array<std::uint32_t, 2>> pairs{};
};

// Those of each pair of sides, by their markers; of a pair whose nodes do not match, within 1e-9 of
// the extent of the mesh, none. The inside of the mesh at one side is taken to the outside at the
// other.
std::vector<PeriodicNodes> periodic_nodes(const MeshView& mesh,
                                          std::span<const std::array<std::int32_t, 2>> sides);

}  // namespace weft::files
