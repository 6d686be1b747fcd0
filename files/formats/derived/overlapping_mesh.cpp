// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/overlapping_mesh.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "checker/geometry/box_tree.h"
#include "files/base/text.h"
#include "files/formats/derived/mesh_edges.h"
#include "files/formats/derived/orientation.h"

namespace weft::files {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

using Corners = std::array<Point, 3>;

// Counter-clockwise.
Corners corners_of(const MeshView& mesh, std::size_t t) {
  Corners corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t v = mesh.triangles[3 * t + k];
    corners[k] = {mesh.coordinates[2 * v], mesh.coordinates[2 * v + 1]};
  }
  if (orientation(corners[0], corners[1], corners[2]) < 0) std::swap(corners[1], corners[2]);
  return corners;
}

// Whether a side of `a` has all of `b` on its outside.
bool has_side_between(const Corners& a, const Corners& b) {
  for (std::size_t k = 0; k < 3; ++k)
    if (std::all_of(b.begin(), b.end(),
                    [&](Point p) { return orientation(a[k], a[(k + 1) % 3], p) <= 0; }))
      return true;
  return false;
}

class Overlaps {
 public:
  Overlaps(const MeshView& mesh, const MeshEdges& edges)
      : mesh_(mesh), edges_(edges), group_(mesh.triangle_count()) {
    connect();
    find();
  }

  bool any() const { return count_ > 0; }
  Warning warning(const std::string& file) const {
    return {.kind = WarningKind::kOverlappingTriangles,
            .file = file,
            .place = "triangle " + std::to_string(first_.first),
            .count = count_,
            .text = with_separators(count_) +
                    " triangles overlap others, the first two are triangle " +
                    std::to_string(first_.first) + " and triangle " +
                    std::to_string(first_.second) + "; what any of them covers is meshed"};
  }
  // The area of each triangle, by the number of its first triangle.
  const std::vector<std::uint32_t>& groups() const { return group_; }

 private:
  std::uint32_t root(std::uint32_t t) {
    while (group_[t] != t) t = group_[t] = group_[group_[t]];
    return t;
  }

  // Groups triangles of one region across common sides.
  void connect() {
    std::iota(group_.begin(), group_.end(), 0u);
    std::vector<std::uint32_t> last_at(edges_.size(), kNone);  // triangle at each edge
    for (std::uint32_t side = 0; side < mesh_.triangles.size(); ++side) {
      std::uint32_t& last = last_at[edges_.of_side(side)];
      const std::uint32_t t = side / 3;
      if (last != kNone && mesh_.regions[last] == mesh_.regions[t]) {
        const auto [low, high] = std::minmax({root(last), root(t)});
        group_[high] = low;
      }
      last = t;
    }
    for (std::uint32_t t = 0; t < group_.size(); ++t) group_[t] = root(t);
  }

  void find() {
    std::vector<check::Box> boxes;
    for (std::size_t t = 0; t < group_.size(); ++t) boxes.push_back(box_of(t));
    const check::BoxTree tree(boxes);
    std::vector<bool> overlaps(group_.size(), false);
    std::vector<bool> is_alone(group_.size(), false);
    for (std::uint32_t t = 0; t < group_.size(); ++t) {
      const Corners corners = corners_of(mesh_, t);
      if (orientation(corners[0], corners[1], corners[2]) == 0) continue;
      std::uint32_t least = kNone;
      tree.visit(boxes[t], [&](std::uint32_t other) {
        if (other <= t) return;
        const Corners others = corners_of(mesh_, other);
        if (orientation(others[0], others[1], others[2]) == 0 ||
            has_side_between(corners, others) || has_side_between(others, corners))
          return;
        overlaps[t] = overlaps[other] = true;
        least = std::min(least, other);
        if (group_[t] == group_[other]) is_alone[other] = true;
      });
      if (least != kNone && first_.second == 0) first_ = {t, least};
    }
    count_ = static_cast<std::size_t>(std::count(overlaps.begin(), overlaps.end(), true));
    for (std::uint32_t t = 0; t < group_.size(); ++t)
      if (is_alone[t]) group_[t] = t;
  }

  check::Box box_of(std::size_t t) const {
    const auto [a, b, c] = corners_of(mesh_, t);
    return {std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::max({a.x, b.x, c.x}),
            std::max({a.y, b.y, c.y})};
  }

  const MeshView& mesh_;
  const MeshEdges& edges_;
  std::vector<std::uint32_t> group_;
  std::size_t count_ = 0;                                // triangles that overlap others
  std::pair<std::uint32_t, std::uint32_t> first_{0, 0};  // two that overlap
};

// The sides of each group that are on its border: (group, edge), sorted.
std::vector<std::pair<std::uint32_t, std::uint32_t>> borders(
    const MeshView& mesh, const MeshEdges& edges, const std::vector<std::uint32_t>& groups) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sides;
  for (std::size_t side = 0; side < mesh.triangles.size(); ++side)
    sides.emplace_back(groups[side / 3], edges.of_side(side));
  std::sort(sides.begin(), sides.end());
  std::vector<std::pair<std::uint32_t, std::uint32_t>> border;
  for (const auto& side : sides) {
    if (!border.empty() && border.back() == side)
      border.pop_back();
    else
      border.push_back(side);
  }
  return border;
}

}  // namespace

std::optional<Domain> domain_of_overlapping(const std::string& name, const MeshView& mesh) {
  const MeshEdges edges(mesh);
  const Overlaps overlaps(mesh, edges);
  if (!overlaps.any()) return std::nullopt;
  const ScratchArray<std::int32_t> markers = edge_markers(mesh, edges);
  Domain domain;
  domain.names = *mesh.names;
  domain.fill = Domain::Fill::kUnion;
  std::vector<std::uint32_t> point_of_vertex(mesh.vertex_count(), kNone);
  const auto point = [&](std::uint32_t v) {
    if (point_of_vertex[v] == kNone) {
      point_of_vertex[v] = static_cast<std::uint32_t>(domain.points.size());
      domain.point_places.extend(domain.points.size(), name + ": vertex ", v);
      domain.points.push_back({mesh.coordinates[2 * v], mesh.coordinates[2 * v + 1]});
    }
    return point_of_vertex[v];
  };
  const auto add = [&](std::uint32_t e) {
    domain.segment_places.extend(domain.segments.size(), name + ": the segment from vertex ",
                                 edges.low(e));
    domain.segments.push_back({point(edges.low(e)), point(edges.high(e)), markers[e],
                               static_cast<std::uint32_t>(domain.areas.size())});
  };
  for (std::size_t i = 0; i < mesh.edge_count(); ++i) add(edges.of_input_edge(i));
  std::uint32_t group = kNone;
  for (const auto& [of_group, e] : borders(mesh, edges, overlaps.groups())) {
    if (of_group != group) {
      group = of_group;
      domain.area_places.extend(domain.areas.size(), name + ": the triangles around triangle ",
                                group);
      domain.areas.emplace_back();
      if (mesh.regions[group] != 0) domain.areas.back().region = mesh.regions[group];
    }
    add(e);
  }
  domain.warnings.push_back(overlaps.warning(name));
  return domain;
}

}  // namespace weft::files
