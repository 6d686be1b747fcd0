// SPDX-License-Identifier: Apache-2.0
#include "checker/mesh_points.h"

#include <algorithm>
#include <cmath>

#include "checker/box_tree.h"

namespace weft::check {

InputPoints::InputPoints(const Domain& domain, const Mesh& mesh) : points_(domain.points) {
  std::sort(points_.begin(), points_.end(), lexicographically_less);
  points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
  vertices_.resize(points_.size());
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec2 p = mesh.vertices[v];
    const auto found = std::lower_bound(points_.begin(), points_.end(), p, lexicographically_less);
    if (found != points_.end() && *found == p)
      vertices_[static_cast<std::size_t>(found - points_.begin())] = v;
  }
}

bool InputPoints::has(Vec2 p) const {
  return std::binary_search(points_.begin(), points_.end(), p, lexicographically_less);
}

std::optional<std::uint32_t> InputPoints::vertex_at(Vec2 input_point) const {
  const auto found =
      std::lower_bound(points_.begin(), points_.end(), input_point, lexicographically_less);
  return vertices_[static_cast<std::size_t>(found - points_.begin())];
}

std::vector<std::optional<std::uint32_t>> vertices_of_arrangement(const Arrangement& arrangement,
                                                                  const InputPoints& input_points,
                                                                  const Mesh& mesh,
                                                                  const ListedEdges& listed,
                                                                  double tolerance) {
  std::vector<std::uint32_t> ends;
  for (std::size_t i = 0; i < mesh.edges.size(); ++i)
    if (listed.half_edge[i]) ends.insert(ends.end(), {mesh.edges[i].a, mesh.edges[i].b});
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::vector<Box> boxes;
  boxes.reserve(ends.size());
  for (const std::uint32_t v : ends) boxes.push_back(box_of(mesh.vertices[v], mesh.vertices[v]));
  const BoxTree tree(std::move(boxes));

  const VertexOrder& order = arrangement.vertices();
  std::vector<std::optional<std::uint32_t>> result(order.size());
  for (std::uint32_t w = 0; w < order.size(); ++w) {
    const Vec2 at = order.at(w);
    if (!order.is_crossing(w) && input_points.has(at)) {
      result[w] = input_points.vertex_at(at);
      continue;
    }
    double nearest = tolerance;
    tree.visit(box_of(at, at).grown(tolerance), [&](std::uint32_t k) {
      const Vec2 p = mesh.vertices[ends[k]];
      const double distance = std::hypot(p.x - at.x, p.y - at.y);
      if (distance > nearest || (distance == nearest && result[w])) return;
      nearest = distance;
      result[w] = ends[k];
    });
  }
  return result;
}

}  // namespace weft::check
