// SPDX-License-Identifier: Apache-2.0
#include "files/formats/triangle/triangle_edges.h"

#include <cstdint>

#include "files/bytes/text_writer.h"
#include "files/formats/derived/mesh_edges.h"

namespace weft::files {

void write_triangle_edges(const MeshView& mesh, OutputFile& file) {
  const MeshEdges edges(mesh);
  const ScratchArray<std::int32_t> markers = edge_markers(mesh, edges);
  put_line(file, edges.size(), 1);
  for (const std::size_t e : mesh.up_to(edges.size()))
    put_line(file, e + 1, edges.low(e) + std::int64_t{1}, edges.high(e) + std::int64_t{1},
             markers[e] == 0 && edges.on_boundary(e) ? 1 : markers[e]);
}

void write_triangle_neighbours(const MeshView& mesh, OutputFile& file) {
  const MeshEdges edges(mesh);
  // The exclusive or of the triangles at each edge: with one of them, it gives the other.
  ScratchArray<std::uint32_t> both(mesh.pages, edges.size());
  for (const std::size_t side : mesh.up_to(mesh.triangles.size()))
    both[edges.of_side(side)] ^= static_cast<std::uint32_t>(side / 3);
  put_line(file, mesh.triangle_count(), 3);
  for (const std::size_t t : mesh.up_to(mesh.triangle_count())) {
    const auto across = [&](std::size_t k) -> std::int64_t {
      const std::uint32_t e = edges.of_side(3 * t + k);
      if (edges.on_boundary(e)) return -1;
      return std::int64_t{both[e] ^ static_cast<std::uint32_t>(t)} + 1;
    };
    put_line(file, t + 1, across(1), across(2), across(0));
  }
}

}  // namespace weft::files
