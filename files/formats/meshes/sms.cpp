// SPDX-License-Identifier: Apache-2.0
#include "files/formats/meshes/sms.h"

#include <cstddef>
#include <cstdint>
#include <string>

#include "files/bytes/text_writer.h"
#include "files/formats/bed.h"
#include "files/formats/derived/mesh_edges.h"

namespace weft::files {
namespace {

// Node strings of one ring.
void put_ring(OutputFile& file, std::span<const std::uint32_t> ring,
              std::span<const std::int32_t> markers, const NameTable& names) {
  constexpr std::size_t kPerLine = 10;
  const std::size_t n = ring.size();
  std::size_t start = 0;  // an edge with another marker than the one before
  while (start < n && markers[start] == markers[(start + n - 1) % n]) ++start;
  const std::size_t first = start % n;
  for (std::size_t i = 0; i < n;) {
    const std::int32_t marker = markers[(first + i) % n];
    std::size_t edges = 1;
    while (i + edges < n && markers[(first + i + edges) % n] == marker) ++edges;
    for (std::size_t k = 0; k <= edges; ++k) {
      const std::int64_t node = ring[(first + i + k) % n] + std::int64_t{1};
      if (k % kPerLine == 0) file.put(k == 0 ? "NS" : "\nNS");
      file.put(' ');
      file.number(k == edges ? -node : node);
    }
    file.put(' ');
    file.number(std::int64_t{marker});
    if (const std::string* const name = name_of(names, marker)) file.put(" \"" + *name + "\"");
    file.put('\n');
    i += edges;
  }
}

}  // namespace

void write_2dm(const MeshView& mesh, OutputFile& file) {
  file.put("MESH2D\nMESHNAME \"weft\"\nNUM_MATERIALS_PER_ELEM 1\n");
  for (const std::size_t t : mesh.up_to(mesh.triangle_count())) {
    const std::uint32_t* corner = &mesh.triangles[3 * t];
    put_line(file, "E3T", t + 1, corner[0] + std::int64_t{1}, corner[1] + std::int64_t{1},
             corner[2] + std::int64_t{1}, mesh.regions[t]);
  }
  const Bed bed(mesh);
  for (const std::size_t v : mesh.up_to(mesh.vertex_count()))
    put_line(file, "ND", v + 1, mesh.coordinates[2 * v], mesh.coordinates[2 * v + 1],
             bed.elevation(v));
  const BoundaryRings rings = boundary_rings(mesh, MeshEdges(mesh));
  for (std::size_t r = 0; r < rings.size(); ++r) {
    const std::size_t first = rings.starts[r];
    const std::size_t count = rings.starts[r + 1] - first;
    put_ring(file, std::span(rings.vertices).subspan(first, count),
             std::span(rings.markers).subspan(first, count), mesh.names->markers);
  }
  if (mesh.names->regions.empty()) return;
  file.put("BEGPARAMDEF\nGM \"weft\"\nENDPARAMDEF\nBEG2DMBC\n");
  for (const auto& [region, name] : mesh.names->regions)
    put_line(file, "MAT", region, "\"" + name + "\"");
  file.put("END2DMBC\n");
}

}  // namespace weft::files
