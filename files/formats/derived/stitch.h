// SPDX-License-Identifier: Apache-2.0
// Joins meshes whose outlines meet vertex by vertex.
//
//   auto joined = stitch(land, sea, {.tolerance = 0.01, .names = {"land.vtu", "sea.vtu"}});
//
// Vertices of the outline of the second that lie within the tolerance of one of the first become
// that one. Vertices, triangles and edges of the first come first, with their numbers. An edge that
// both list has the marker of the first. Of a number that has another name in the second than in
// the first, the second's is renumbered; of a name with another number, it has that of the first.
//
// Errors (kUnreadableInput), which name the first offender: no vertex in common; two vertices of
// one mesh within the tolerance of one of the other; a vertex of one outline on an edge of the
// other; triangles that overlap. Not thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "files/base/error.h"
#include "files/formats/mesh.h"

namespace weft::files {

struct StitchOptions {
  double tolerance = 0;                // in the unit of the points; 0: 1e-9 of the extent of both
  std::array<std::string, 2> names{};  // of the meshes, for errors
};

struct StitchedMesh {
  Mesh mesh;
  std::vector<std::uint32_t> vertices;  // per vertex of the second mesh: that of the new one
  std::size_t common_vertices = 0;
  std::size_t common_edges = 0;  // of both outlines, now inside
};

// REQUIRES: triangles are counter-clockwise; vertex numbers are in range.
Result<StitchedMesh> stitch(const Mesh& first, const Mesh& second, const StitchOptions& options);

}  // namespace weft::files
