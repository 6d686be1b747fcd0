// SPDX-License-Identifier: Apache-2.0
// Divides a mesh into parts for as many processes, by METIS (Karypis and Kumar, A fast and high
// quality multilevel scheme for partitioning irregular graphs, 1998): parts have about the same
// number of triangles, and few sides between them. The same mesh gives the same parts.
//
// Takes some 120 bytes of memory per triangle. Errors (kUsage): more parts than triangles; METIS
// fails, or this weft was built without it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "files/base/error.h"
#include "files/formats/mesh.h"

namespace weft::files {

inline constexpr std::uint32_t kMaxParts = 1 << 16;

struct MeshParts {
  std::vector<std::int32_t> of;  // the part of each triangle, from 0
  std::size_t least = 0;         // triangles of the smallest part
  std::size_t most = 0;
  std::size_t cut = 0;  // sides between two parts
};

// Succeeds if this weft was built with METIS.
Result<void> check_can_divide();

// REQUIRES: parts > 0, mesh.order is 1.
Result<MeshParts> divide(const MeshView& mesh, std::uint32_t parts);

}  // namespace weft::files
