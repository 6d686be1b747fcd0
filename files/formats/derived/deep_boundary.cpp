// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/deep_boundary.h"

#include <set>

#include "files/formats/bed.h"
#include "files/formats/derived/mesh_edges.h"

namespace weft::files {
namespace {

// Of each edge of a ring, whether both ends are deep and it has none of the markers.
std::vector<bool> deep_edges(std::span<const std::uint32_t> ring,
                             std::span<const std::int32_t> markers, const Bed& bed, double deeper,
                             const std::set<std::int32_t>& open) {
  const std::size_t n = ring.size();
  const auto is_deeper = [&](std::size_t i) { return bed.depth(ring[i % n]) > deeper; };
  const auto is_deep = [&](std::size_t i) {
    return is_deeper(i) || (is_deeper(i + n - 1) && is_deeper(i + 1));
  };
  std::vector<bool> deep(n);
  for (std::size_t i = 0; i < n; ++i)
    deep[i] = is_deep(i) && is_deep(i + 1) && !open.contains(markers[i]);
  return deep;
}

}  // namespace

DeepBoundary deep_boundary(const MeshView& mesh, double deeper,
                           std::span<const std::int32_t> open_markers) {
  DeepBoundary out{{mesh.edges.begin(), mesh.edges.end()},
                   {mesh.edge_markers.begin(), mesh.edge_markers.end()}};
  const std::set<std::int32_t> open(open_markers.begin(), open_markers.end());
  std::set<std::int32_t> taken(mesh.edge_markers.begin(), mesh.edge_markers.end());
  taken.insert(open.begin(), open.end());
  while (taken.contains(out.marker)) ++out.marker;
  const Bed bed(mesh);
  const BoundaryRings rings = boundary_rings(mesh, MeshEdges(mesh));
  for (std::size_t r = 0; r < rings.size(); ++r) {
    const std::size_t first = rings.starts[r];
    const std::size_t n = rings.starts[r + 1] - first;
    const auto ring = std::span(rings.vertices).subspan(first, n);
    if (signed_area(mesh, ring) < 0) continue;
    const auto deep =
        deep_edges(ring, std::span(rings.markers).subspan(first, n), bed, deeper, open);
    for (std::size_t i = 0; i < n; ++i) {
      if (!deep[i] || !(deep[(i + n - 1) % n] || deep[(i + 1) % n])) continue;
      out.edges.insert(out.edges.end(), {ring[i], ring[(i + 1) % n]});
      out.markers.push_back(out.marker);
      ++out.opened;
    }
  }
  return out;
}

}  // namespace weft::files
