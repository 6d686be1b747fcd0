// SPDX-License-Identifier: Apache-2.0
#include "checker/size/gradation_within.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <unordered_map>
#include <utility>

#include "checker/size/gradation.h"

namespace weft::check {
namespace {

double distance(Vec2 p, Vec2 q) {
  return std::sqrt((p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y));
}

double turn(Vec2 a, Vec2 b, Vec2 c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

std::vector<Box> boxes_of(const Mesh& mesh) {
  std::vector<Box> boxes;
  for (const auto& [a, b, c] : mesh.triangles) {
    boxes.push_back(box_of(mesh.vertices[a], mesh.vertices[b]));
    boxes.back().add(box_of(mesh.vertices[c], mesh.vertices[c]));
  }
  return boxes;
}

// Pairs of vertices with a straight way between them in the mesh: edges, and across edges.
std::vector<std::array<std::uint32_t, 2>> ways(const Mesh& mesh) {
  std::vector<std::array<std::uint32_t, 2>> found;
  std::unordered_map<std::uint64_t, std::uint32_t> apexes;  // of triangles, by their edges
  const auto key = [](std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} << 32 | b; };
  for (const auto& t : mesh.triangles)
    for (unsigned k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k];
      const std::uint32_t b = t[(k + 1) % 3];
      const std::uint32_t c = t[(k + 2) % 3];
      apexes[key(a, b)] = c;
      found.push_back({a, b});
      const auto beside = apexes.find(key(b, a));
      if (beside == apexes.end()) continue;
      const std::uint32_t d = beside->second;
      const auto at = [&](std::uint32_t v) { return mesh.vertices[v]; };
      if (turn(at(c), at(d), at(a)) * turn(at(c), at(d), at(b)) < 0) found.push_back({c, d});
    }
  return found;
}

}  // namespace

GradationWithin::GradationWithin(const Mesh& mesh, const std::vector<double>& areas,
                                 double gradation)
    : mesh_(mesh), gradation_(gradation), tree_(boxes_of(mesh)) {
  for (const double area : areas)
    edges_.push_back(area >= 0 ? edge_of_area(area) : std::numeric_limits<double>::infinity());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec2 centroid{(mesh.vertices[a].x + mesh.vertices[b].x + mesh.vertices[c].x) / 3,
                        (mesh.vertices[a].y + mesh.vertices[b].y + mesh.vertices[c].y) / 3};
    for (const std::uint32_t v : {a, b, c})
      edges_[v] = std::min(edges_[v], edges_[mesh.vertices.size() + t] +
                                          gradation * distance(centroid, mesh.vertices[v]));
  }
  spread();
}

// E. W. Dijkstra's algorithm.
void GradationWithin::spread() {
  std::vector<std::vector<std::uint32_t>> beside(mesh_.vertices.size());
  for (const auto& [a, b] : ways(mesh_)) {
    beside[a].push_back(b);
    beside[b].push_back(a);
  }
  using Open = std::pair<double, std::uint32_t>;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
  for (std::uint32_t v = 0; v < beside.size(); ++v)
    if (std::isfinite(edges_[v])) open.emplace(edges_[v], v);
  while (!open.empty()) {
    const auto [edge, v] = open.top();
    open.pop();
    if (edge != edges_[v]) continue;
    for (const std::uint32_t w : beside[v]) {
      const double to = edge + gradation_ * distance(mesh_.vertices[v], mesh_.vertices[w]);
      if (!(to < edges_[w])) continue;
      edges_[w] = to;
      open.emplace(to, w);
    }
  }
}

double GradationWithin::operator()(Vec2 p, double area) const {
  double edge = edge_of_area(area);
  bool limited = false;
  const auto lower = [&](double to) {
    limited = limited || to < edge;
    edge = std::min(edge, to);
  };
  tree_.visit(box_of(p, p), [&](std::uint32_t t) {
    const auto& [a, b, c] = mesh_.triangles[t];
    const std::array<Vec2, 3> at{mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]};
    for (unsigned k = 0; k < 3; ++k)
      if (turn(at[k], at[(k + 1) % 3], p) < 0) return;
    for (const std::uint32_t v : {a, b, c})
      lower(edges_[v] + gradation_ * distance(mesh_.vertices[v], p));
  });
  return limited ? area_of_edge(edge) : area;
}

}  // namespace weft::check
