// SPDX-License-Identifier: Apache-2.0
#include "checker/domain/mesh_points.h"

#include <algorithm>
#include <cmath>

#include "checker/domain/tolerance.h"
#include "checker/geometry/box_tree.h"
#include "checker/text.h"

namespace weft::check {
namespace {

constexpr std::uint32_t kNoPoint = 0xffffffffu;

}  // namespace

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

void judge_named_points(const Domain& domain, const NearFeatures& near, const Mesh& mesh,
                        Findings& findings) {
  std::vector<char> named(mesh.input_points.empty() ? 0 : mesh.vertices.size(), 0);
  std::vector<char> given(mesh.input_points.empty() ? 0 : domain.points.size(), 0);
  for (const auto& pair : mesh.input_points) {
    const std::uint32_t v = pair[0], i = pair[1];
    const auto bad = [&](const auto&... parts) {
      findings.add(Rule::kPoints,
                   [&] { return say("vertex ", v, " for point ", i, ": ", parts...); });
    };
    if (v >= mesh.vertices.size() || i >= domain.points.size()) {
      bad("there is no such one");
      continue;
    }
    if (named[v] || given[i]) bad("named before");
    named[v] = given[i] = 1;
    const Vec2 p = mesh.vertices[v], q = domain.points[i];
    const double allowed = near.may_move[i] ? near.merging_distance * (1 + kMergingSlack) : 0;
    if (const double distance = std::hypot(p.x - q.x, p.y - q.y); distance > allowed)
      bad("the vertex is at ", p, ", the point at ", q, ", ", distance, " apart");
  }
}

std::vector<std::optional<std::uint32_t>> images_of_points(const Domain& domain,
                                                           const NearFeatures& near,
                                                           const Mesh& mesh) {
  const InputPoints exact(domain, mesh);
  std::vector<std::optional<std::uint32_t>> images(domain.points.size());
  std::vector<std::uint32_t> moved;
  for (std::uint32_t i = 0; i < images.size(); ++i) {
    images[i] = exact.vertex_at(domain.points[i]);
    if (!images[i] && near.may_move[i]) moved.push_back(i);
  }
  if (moved.empty()) return images;

  // What the lowest input point at its place says about a vertex.
  std::vector<std::uint32_t> lowest(mesh.vertices.size(), kNoPoint);
  for (std::uint32_t i = 0; i < images.size(); ++i)
    if (images[i]) lowest[*images[i]] = std::min(lowest[*images[i]], i);

  struct Merit {
    int kind;  // 0: at a lower input point, 1: at an input point, 2: neither
    double distance;
    auto operator<=>(const Merit&) const = default;
  };
  const double reach = near.merging_distance * (1 + kMergingSlack);
  std::vector<Merit> best(moved.size(), Merit{3, 0});
  std::vector<Box> boxes;
  boxes.reserve(moved.size());
  for (const std::uint32_t i : moved)
    boxes.push_back(box_of(domain.points[i], domain.points[i]).grown(reach));
  const BoxTree tree(std::move(boxes));
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec2 q = mesh.vertices[v];
    tree.visit(box_of(q, q), [&](std::uint32_t k) {
      const std::uint32_t i = moved[k];
      const double distance = std::hypot(q.x - domain.points[i].x, q.y - domain.points[i].y);
      const Merit merit{lowest[v] < i ? 0 : lowest[v] != kNoPoint ? 1 : 2, distance};
      if (distance > reach || !(merit < best[k])) return;
      best[k] = merit;
      images[i] = v;
    });
  }
  return images;
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
