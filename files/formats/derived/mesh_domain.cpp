// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/mesh_domain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "files/base/text.h"
#include "files/formats/derived/mesh_edges.h"
#include "files/formats/derived/overlapping_mesh.h"

namespace weft::files {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// The two triangles at each edge, or kNone: enough to walk from one to the next.
std::vector<std::uint32_t> triangles_at_edges(const MeshView& mesh, const MeshEdges& edges) {
  std::vector<std::uint32_t> at(2 * edges.size(), kNone);
  for (std::size_t side = 0; side < mesh.triangles.size(); ++side) {
    std::uint32_t* both = &at[2 * std::size_t{edges.of_side(side)}];
    both[both[0] == kNone ? 0 : 1] = static_cast<std::uint32_t>(side / 3);
  }
  return at;
}

double area(const MeshView& mesh, std::size_t t) {
  const auto at = [&](std::size_t k) {
    return &mesh.coordinates[2 * std::size_t{mesh.triangles[k]}];
  };
  const double* a = at(3 * t);
  const double* b = at(3 * t + 1);
  const double* c = at(3 * t + 2);
  return std::abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
}

Point centroid(const MeshView& mesh, std::size_t t) {
  Point sum;
  for (std::size_t k = 0; k < 3; ++k) {
    sum.x += mesh.coordinates[2 * std::size_t{mesh.triangles[3 * t + k]}] / 3;
    sum.y += mesh.coordinates[2 * std::size_t{mesh.triangles[3 * t + k]} + 1] / 3;
  }
  return sum;
}

// A seed in the largest triangle of every part between segments whose region is not 0.
void add_regions(const std::string& name, const MeshView& mesh, const MeshEdges& edges,
                 const std::vector<std::uint32_t>& at_edge, const std::vector<bool>& is_segment,
                 Domain& domain) {
  std::vector<bool> seen(mesh.triangle_count(), false);
  std::vector<std::uint32_t> open;
  for (std::size_t start = 0; start < seen.size(); ++start) {
    if (seen[start] || mesh.regions[start] == 0) continue;
    std::size_t largest = start;
    seen[start] = true;
    open.assign(1, static_cast<std::uint32_t>(start));
    while (!open.empty()) {
      const std::size_t t = open.back();
      open.pop_back();
      if (area(mesh, t) > area(mesh, largest)) largest = t;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t e = edges.of_side(3 * t + k);
        if (is_segment[e]) continue;
        for (const std::uint32_t next :
             {at_edge[2 * std::size_t{e}], at_edge[2 * std::size_t{e} + 1]})
          if (next != kNone && !seen[next]) {
            seen[next] = true;
            open.push_back(next);
          }
      }
    }
    domain.region_places.extend(domain.regions.size(), name + ": the region of triangle ", largest);
    domain.regions.push_back({centroid(mesh, largest), mesh.regions[start], std::nullopt});
  }
}

// The numbers of triangles that have the corners of one before them, ascending.
std::vector<std::uint32_t> repeated_triangles(const MeshView& mesh) {
  std::vector<std::array<std::uint32_t, 4>> by_corners(mesh.triangle_count());
  for (std::size_t t = 0; t < by_corners.size(); ++t) {
    std::array<std::uint32_t, 4>& entry = by_corners[t];
    std::copy_n(&mesh.triangles[3 * t], 3, entry.begin());
    std::sort(entry.begin(), entry.begin() + 3);
    entry[3] = static_cast<std::uint32_t>(t);
  }
  std::sort(by_corners.begin(), by_corners.end());
  std::vector<std::uint32_t> repeated;
  for (std::size_t i = 1; i < by_corners.size(); ++i)
    if (std::equal(by_corners[i].begin(), by_corners[i].begin() + 3, by_corners[i - 1].begin()))
      repeated.push_back(by_corners[i][3]);
  std::sort(repeated.begin(), repeated.end());
  return repeated;
}

Domain domain_of_single_triangles(const std::string& name, const MeshView& mesh) {
  if (auto overlapping = domain_of_overlapping(name, mesh)) return std::move(*overlapping);
  const MeshEdges edges(mesh);
  const ScratchArray<std::int32_t> markers = edge_markers(mesh, edges);
  const std::vector<std::uint32_t> at_edge = triangles_at_edges(mesh, edges);
  std::vector<bool> is_segment(edges.size(), false);
  for (std::size_t i = 0; i < mesh.edge_count(); ++i) is_segment[edges.of_input_edge(i)] = true;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const std::uint32_t a = at_edge[2 * e];
    const std::uint32_t b = at_edge[2 * e + 1];
    if (a != kNone && (b == kNone || mesh.regions[a] != mesh.regions[b])) is_segment[e] = true;
  }

  Domain domain;
  domain.names = *mesh.names;
  domain.fill = mesh.triangles.empty() ? Domain::Fill::kSeeds : Domain::Fill::kEvenOdd;
  std::vector<std::uint32_t> point_of_vertex(mesh.vertex_count(), kNone);
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (is_segment[e]) point_of_vertex[edges.low(e)] = point_of_vertex[edges.high(e)] = 0;
  for (std::size_t v = 0; v < point_of_vertex.size(); ++v) {
    if (point_of_vertex[v] == kNone) continue;
    point_of_vertex[v] = static_cast<std::uint32_t>(domain.points.size());
    domain.point_places.extend(domain.points.size(), name + ": vertex ", v);
    domain.points.push_back({mesh.coordinates[2 * v], mesh.coordinates[2 * v + 1]});
  }
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (!is_segment[e]) continue;
    const bool inside = domain.fill == Domain::Fill::kEvenOdd && !edges.on_boundary(e);
    for (int time = 0; time < (inside ? 2 : 1); ++time) {
      domain.segment_places.extend(domain.segments.size(), name + ": the segment from vertex ",
                                   edges.low(e));
      domain.segments.push_back(
          {point_of_vertex[edges.low(e)], point_of_vertex[edges.high(e)], markers[e]});
    }
  }
  add_regions(name, mesh, edges, at_edge, is_segment, domain);
  return domain;
}

}  // namespace

Domain domain_of_mesh(const std::string& name, const MeshView& mesh) {
  const std::vector<std::uint32_t> repeated = repeated_triangles(mesh);
  if (repeated.empty()) return domain_of_single_triangles(name, mesh);
  std::vector<std::uint32_t> triangles;
  std::vector<std::int32_t> regions;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    if (std::binary_search(repeated.begin(), repeated.end(), t)) continue;
    triangles.insert(triangles.end(), &mesh.triangles[3 * t], &mesh.triangles[3 * t] + 3);
    regions.push_back(mesh.regions[t]);
  }
  MeshView single = mesh;
  single.triangles = triangles;
  single.regions = regions;
  Domain domain = domain_of_single_triangles(name, single);
  const bool one = repeated.size() == 1;
  const std::string first = "triangle " + std::to_string(repeated[0]);
  domain.warnings.push_back(
      {.kind = WarningKind::kRepeatedTriangle,
       .file = name,
       .place = first,
       .count = repeated.size(),
       .text = with_separators(repeated.size()) +
               (one ? " triangle that repeats another is left out, "
                    : " triangles that repeat others are left out, the first is ") +
               first});
  return domain;
}

}  // namespace weft::files
