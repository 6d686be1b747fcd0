// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "files/bytes/text_writer.h"
#include "files/formats/bed.h"
#include "files/formats/derived/mesh_edges.h"
#include "files/formats/meshes/adcirc.h"

namespace weft::files {
namespace {

constexpr int kMainland = 0;
constexpr int kIsland = 1;

struct Piece {
  std::vector<std::uint32_t> vertices;
  std::optional<std::int32_t> marker;  // none if they differ
  int type = kMainland;                // of land
};

struct Boundaries {
  std::vector<Piece> open;
  std::vector<Piece> land;
};

void add_ring(const MeshView& mesh, std::span<const std::uint32_t> ring,
              std::span<const std::int32_t> markers, std::span<const std::int32_t> open_markers,
              Boundaries& out) {
  const auto is_open = [&](std::int32_t marker) {
    return std::find(open_markers.begin(), open_markers.end(), marker) != open_markers.end();
  };
  const std::size_t n = ring.size();
  std::size_t start = 0;  // an edge with another marker than the one before
  while (start < n && markers[start] == markers[(start + n - 1) % n]) ++start;
  const bool uniform = start == n;

  if (std::none_of(markers.begin(), markers.end(), is_open) && signed_area(mesh, ring) < 0) {
    Piece island{{ring.begin(), ring.end()}, std::nullopt, kIsland};
    if (uniform) island.marker = markers[0];
    out.land.push_back(std::move(island));
    return;
  }
  if (uniform) {
    Piece whole{{ring.begin(), ring.end()}, markers[0], kMainland};
    if (!is_open(markers[0])) whole.vertices.push_back(ring[0]);
    (is_open(markers[0]) ? out.open : out.land).push_back(std::move(whole));
    return;
  }
  for (std::size_t first = start; first < start + n;) {
    const std::int32_t marker = markers[first % n];
    Piece piece{{ring[first % n]}, marker, kMainland};
    for (; first < start + n && markers[first % n] == marker; ++first)
      piece.vertices.push_back(ring[(first + 1) % n]);
    (is_open(marker) ? out.open : out.land).push_back(std::move(piece));
  }
}

void put_pieces(OutputFile& file, const std::vector<Piece>& pieces, const std::string& kind) {
  std::size_t nodes = 0;
  for (const Piece& piece : pieces) nodes += piece.vertices.size();
  put_line(file, pieces.size(), "= Number of " + kind + " boundaries");
  put_line(file, nodes, "= Total number of " + kind + " boundary nodes");
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Piece& piece = pieces[i];
    put_line(file, piece.vertices.size(), piece.type,
             "= Number of nodes for " + kind + " boundary " + std::to_string(i + 1) +
                 (piece.marker ? ", marker " + std::to_string(*piece.marker) : ""));
    for (const std::uint32_t v : piece.vertices) put_line(file, v + std::int64_t{1});
  }
}

}  // namespace

void write_adcirc(const MeshView& mesh, std::span<const std::int32_t> open_boundaries,
                  OutputFile& file) {
  file.put("weft\n");
  put_line(file, mesh.triangle_count(), mesh.vertex_count());
  const Bed bed(mesh);
  for (const std::size_t v : mesh.up_to(mesh.vertex_count()))
    put_line(file, v + 1, mesh.coordinates[2 * v], mesh.coordinates[2 * v + 1], bed.depth(v));
  for (const std::size_t t : mesh.up_to(mesh.triangle_count())) {
    const std::uint32_t* corner = &mesh.triangles[3 * t];
    put_line(file, t + 1, 3, corner[0] + std::int64_t{1}, corner[1] + std::int64_t{1},
             corner[2] + std::int64_t{1});
  }
  const BoundaryRings rings = boundary_rings(mesh, MeshEdges(mesh));
  Boundaries boundaries;
  for (std::size_t r = 0; r < rings.size(); ++r) {
    const std::size_t first = rings.starts[r];
    const std::size_t count = rings.starts[r + 1] - first;
    add_ring(mesh, std::span(rings.vertices).subspan(first, count),
             std::span(rings.markers).subspan(first, count), open_boundaries, boundaries);
  }
  put_pieces(file, boundaries.open, "open");
  put_pieces(file, boundaries.land, "land");
}

}  // namespace weft::files
