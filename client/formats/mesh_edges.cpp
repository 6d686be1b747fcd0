// SPDX-License-Identifier: Apache-2.0
#include "client/formats/mesh_edges.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace weft::client {

MeshEdges::MeshEdges(const MeshView& mesh)
    : sides_(mesh.triangles.size()), edge_of_side_(sides_ + mesh.edge_count()) {
  const auto ends_of = [&](std::size_t side) -> std::pair<std::uint32_t, std::uint32_t> {
    if (side >= sides_) {
      const std::size_t i = side - sides_;
      return std::minmax(mesh.edges[2 * i], mesh.edges[2 * i + 1]);
    }
    return std::minmax(mesh.triangles[side], mesh.triangles[side % 3 == 2 ? side - 2 : side + 1]);
  };
  // Sides by their lower vertex: a counting sort, then a sort of the few that share it.
  std::vector<std::uint32_t> starts(mesh.vertex_count() + 1, 0);
  for (std::size_t side = 0; side < edge_of_side_.size(); ++side) ++starts[ends_of(side).first + 1];
  for (std::size_t v = 1; v < starts.size(); ++v) starts[v] += starts[v - 1];
  std::vector<std::uint32_t> sides(edge_of_side_.size());
  std::vector<std::uint32_t> next(starts.begin(), starts.end() - 1);
  for (std::size_t side = 0; side < sides.size(); ++side)
    sides[next[ends_of(side).first]++] = static_cast<std::uint32_t>(side);
  next = {};

  ends_.reserve(sides.size() + 2);
  triangles_at_.reserve(sides.size() / 2 + 1);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> at_vertex;  // higher vertex, side
  for (std::size_t low = 0; low + 1 < starts.size(); ++low) {
    at_vertex.clear();
    for (std::size_t i = starts[low]; i < starts[low + 1]; ++i)
      at_vertex.emplace_back(ends_of(sides[i]).second, sides[i]);
    std::sort(at_vertex.begin(), at_vertex.end());
    for (std::size_t i = 0; i < at_vertex.size(); ++i) {
      const auto [high, side] = at_vertex[i];
      if (i == 0 || high != at_vertex[i - 1].first) {
        ends_.push_back(static_cast<std::uint32_t>(low));
        ends_.push_back(high);
        triangles_at_.push_back(0);
      }
      edge_of_side_[side] = static_cast<std::uint32_t>(triangles_at_.size() - 1);
      if (side < sides_ && triangles_at_.back() < 2) ++triangles_at_.back();
    }
  }
}

std::vector<std::int32_t> edge_markers(const MeshView& mesh, const MeshEdges& edges) {
  std::vector<std::int32_t> markers(edges.size(), 0);
  for (std::size_t i = 0; i < mesh.edge_count(); ++i)
    markers[edges.of_input_edge(i)] = mesh.edge_markers[i];
  return markers;
}

BoundaryRings boundary_rings(const MeshView& mesh, const MeshEdges& edges) {
  const std::vector<std::int32_t> markers = edge_markers(mesh, edges);
  struct Side {
    std::uint32_t from;
    std::uint32_t to;
    std::int32_t marker;
    bool used;
  };
  std::vector<Side> sides;
  for (std::size_t side = 0; side < mesh.triangles.size(); ++side) {
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

}  // namespace weft::client
