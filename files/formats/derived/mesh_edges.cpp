// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/mesh_edges.h"

#include <algorithm>
#include <cerrno>
#include <limits>
#include <system_error>
#include <utility>
#include <vector>

namespace weft::files {

MeshEdges::MeshEdges(const MeshView& mesh)
    : sides_(mesh.triangles.size()), edge_of_side_(mesh.pages, sides_ + mesh.edge_count()) {
  const std::size_t count = edge_of_side_.size();
  if (count > std::numeric_limits<std::uint32_t>::max())
    throw std::system_error(EOVERFLOW, std::generic_category());
  const auto ends_of = [&](std::size_t side) -> std::pair<std::uint32_t, std::uint32_t> {
    if (side >= sides_) {
      const std::size_t i = side - sides_;
      return std::minmax(mesh.edges[2 * i], mesh.edges[2 * i + 1]);
    }
    return std::minmax(mesh.triangles[side], mesh.triangles[side % 3 == 2 ? side - 2 : side + 1]);
  };
  // Sorts sides by their lower vertex with a counting sort, then the few that share it.
  const std::size_t vertices = mesh.vertex_count();
  ScratchArray<std::uint32_t> ends(mesh.pages, vertices);  // in `sides`, of those of each vertex
  for (const std::size_t side : mesh.up_to(count)) ++ends[ends_of(side).first];
  std::uint32_t before = 0;
  for (const std::size_t v : mesh.up_to(vertices)) before += std::exchange(ends[v], before);
  ScratchArray<std::uint32_t> sides(mesh.pages, count);
  for (const std::size_t side : mesh.up_to(count))
    sides[ends[ends_of(side).first]++] = static_cast<std::uint32_t>(side);

  ends_ = ScratchArray<std::uint32_t>(mesh.pages, 2 * count);
  triangles_at_ = ScratchArray<std::uint8_t>(mesh.pages, count);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> at_vertex;  // higher vertex, side
  Jumps jumps(mesh.pages);  // the first vertices have sides all over the mesh
  std::size_t first = 0;
  for (const std::size_t low : mesh.up_to(vertices)) {
    at_vertex.clear();
    for (; first < ends[low]; ++first) {
      jumps.to(sides[first]);
      at_vertex.emplace_back(ends_of(sides[first]).second, sides[first]);
    }
    std::sort(at_vertex.begin(), at_vertex.end());
    for (std::size_t i = 0; i < at_vertex.size(); ++i) {
      const auto [high, side] = at_vertex[i];
      if (i == 0 || high != at_vertex[i - 1].first) {
        ends_[2 * size_] = static_cast<std::uint32_t>(low);
        ends_[2 * size_ + 1] = high;
        ++size_;
      }
      edge_of_side_[side] = static_cast<std::uint32_t>(size_ - 1);
      if (side < sides_ && triangles_at_[size_ - 1] < 2) ++triangles_at_[size_ - 1];
    }
  }
}

ScratchArray<std::int32_t> edge_markers(const MeshView& mesh, const MeshEdges& edges) {
  ScratchArray<std::int32_t> markers(mesh.pages, edges.size());
  for (const std::size_t i : mesh.up_to(mesh.edge_count()))
    markers[edges.of_input_edge(i)] = mesh.edge_markers[i];
  return markers;
}

ScratchArray<std::uint32_t> opposite_sides(const MeshView& mesh, const MeshEdges& edges) {
  ScratchArray<std::uint32_t> opposite(mesh.pages, 3 * mesh.triangle_count());
  ScratchArray<std::uint32_t> waiting(mesh.pages, edges.size());
  for (const std::size_t e : mesh.up_to(edges.size())) waiting[e] = kNoSide;
  Jumps jumps(mesh.pages);
  for (const std::size_t s : mesh.up_to(opposite.size())) {
    const auto side = static_cast<std::uint32_t>(s);
    std::uint32_t& other = waiting[edges.of_side(s)];
    jumps.to(edges.of_side(s));
    opposite[s] = other;
    if (other != kNoSide) opposite[other] = side;
    other = other == kNoSide ? side : kNoSide;
  }
  return opposite;
}

ScratchArray<std::uint32_t> first_sides(const MeshView& mesh, const MeshEdges& edges) {
  ScratchArray<std::uint32_t> first(mesh.pages, edges.size());
  for (const std::size_t e : mesh.up_to(edges.size())) first[e] = kNoSide;
  Jumps jumps(mesh.pages);
  for (const std::size_t s : mesh.up_to(3 * mesh.triangle_count())) {
    const std::uint32_t e = edges.of_side(s);
    jumps.to(e);
    if (first[e] == kNoSide) first[e] = static_cast<std::uint32_t>(s);
  }
  return first;
}

BoundaryRings boundary_rings(const MeshView& mesh, const MeshEdges& edges) {
  const ScratchArray<std::int32_t> markers = edge_markers(mesh, edges);
  struct Side {
    std::uint32_t from;
    std::uint32_t to;
    std::int32_t marker;
    bool used;
  };
  std::vector<Side> sides;
  for (const std::size_t side : mesh.up_to(mesh.triangles.size())) {
    const std::uint32_t e = edges.of_side(side);
    if (edges.on_boundary(e))
      sides.push_back({mesh.triangles[side], mesh.triangles[side % 3 == 2 ? side - 2 : side + 1],
                       markers[e], false});
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.from != b.from ? a.from < b.from : a.to < b.to;
  });
  const auto first_from = [&sides](std::uint32_t v) {
    return static_cast<std::size_t>(
        std::lower_bound(sides.begin(), sides.end(), v,
                         [](const Side& side, std::uint32_t at) { return side.from < at; }) -
        sides.begin());
  };

  BoundaryRings rings;
  rings.starts.push_back(0);
  constexpr std::size_t kNowhere = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> place(sides.size(), kNowhere);  // on the path, by first_from(vertex)
  std::vector<std::size_t> path;                           // of sides
  for (std::size_t start = 0; start < sides.size(); ++start) {
    if (sides[start].used) continue;
    path.clear();
    std::size_t vertex = first_from(sides[start].from);
    for (;;) {
      if (place[vertex] != kNowhere) {  // the path has come back to one of its vertices
        const std::size_t ring = place[vertex];
        for (std::size_t i = ring; i < path.size(); ++i) {
          const Side& side = sides[path[i]];
          rings.vertices.push_back(side.from);
          rings.markers.push_back(side.marker);
          place[first_from(side.from)] = kNowhere;
        }
        rings.starts.push_back(rings.vertices.size());
        path.resize(ring);
      }
      std::size_t side = vertex;
      while (side < sides.size() && sides[side].from == sides[vertex].from && sides[side].used)
        ++side;
      if (side == sides.size() || sides[side].from != sides[vertex].from) break;
      sides[side].used = true;
      place[vertex] = path.size();
      path.push_back(side);
      vertex = first_from(sides[side].to);
      if (vertex == sides.size() || sides[vertex].from != sides[side].to) break;
    }
    for (const std::size_t side : path) place[first_from(sides[side].from)] = kNowhere;
  }
  return rings;
}

double signed_area(const MeshView& mesh, std::span<const std::uint32_t> ring) {
  const double* origin = &mesh.coordinates[2 * std::size_t{ring[0]}];
  double area = 0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    const double* a = &mesh.coordinates[2 * std::size_t{ring[i]}];
    const double* b = &mesh.coordinates[2 * std::size_t{ring[i + 1]}];
    area += (a[0] - origin[0]) * (b[1] - origin[1]) - (a[1] - origin[1]) * (b[0] - origin[0]);
  }
  return area;
}

}  // namespace weft::files
