// SPDX-License-Identifier: Apache-2.0
#include "tests/checker/lattice.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <stdexcept>

namespace weft::check::testing {

std::set<Rule> violated(const Report& report) {
  std::set<Rule> rules;
  for (const Violation& violation : report.violations) rules.insert(violation.rule);
  return rules;
}

Lattice& Lattice::segment(Node a, Node b, std::int32_t marker) {
  sides_.push_back({a, b, marker});
  return *this;
}

Lattice& Lattice::box(Node low, Node high, std::int32_t marker) {
  segment(low, {high[0], low[1]}, marker);
  segment({high[0], low[1]}, high, marker);
  segment(high, {low[0], high[1]}, marker);
  return segment({low[0], high[1]}, low, marker);
}

namespace {

Vec2 inside_cell(Lattice::Node cell) {
  const Vec2 corner = Lattice::at(cell);
  return {corner.x + 0.5, corner.y + 0.25};
}

}  // namespace

Lattice& Lattice::hole_seed_in_cell(Node cell) {
  holes_.push_back(inside_cell(cell));
  return *this;
}

Lattice& Lattice::region_in_cell(Node cell, std::int32_t id) {
  regions_.push_back({inside_cell(cell), id, std::nullopt});
  return *this;
}

Problem Lattice::build(const std::function<bool(Node)>& keep,
                       const std::function<std::int32_t(Node)>& region) const {
  Problem problem;
  Domain& domain = problem.domain;
  Mesh& mesh = problem.mesh;
  domain.holes = holes_;
  domain.regions = regions_;

  std::map<Node, std::uint32_t> vertices;
  const auto vertex_of = [&](Node node) {
    const auto [place, is_new] =
        vertices.emplace(node, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back(at(node));
    return place->second;
  };
  for (int j = 0; j < size_; ++j) {
    for (int i = 0; i < size_; ++i) {
      if (!keep({i, j})) continue;
      const std::uint32_t a = vertex_of({i, j}), b = vertex_of({i + 1, j});
      const std::uint32_t c = vertex_of({i + 1, j + 1}), d = vertex_of({i, j + 1});
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({b, c, d});
      if (region) mesh.regions.insert(mesh.regions.end(), 2, region({i, j}));
    }
  }
  std::map<Node, std::uint32_t> points;
  const auto point_of = [&](Node node) {
    const auto [place, is_new] =
        points.emplace(node, static_cast<std::uint32_t>(domain.points.size()));
    if (is_new) domain.points.push_back(at(node));
    return place->second;
  };
  for (const auto& [a, b, marker] : sides_) {
    domain.segments.push_back({point_of(a), point_of(b)});
    domain.markers.push_back(marker);
    const int steps = std::max(std::abs(b[0] - a[0]), std::abs(b[1] - a[1]));
    const Node step = {(b[0] - a[0]) / steps, (b[1] - a[1]) / steps};
    Node from = a;
    for (int k = 0; k < steps; ++k) {
      const Node to = {from[0] + step[0], from[1] + step[1]};
      if (vertices.contains(from) && vertices.contains(to))
        mesh.edges.push_back({vertices[from], vertices[to], marker});
      from = to;
    }
  }
  problem.requirements.min_angle_deg = 53;
  problem.requirements.max_area = 0.5;
  return problem;
}

Problem block(int size) {
  return Lattice(size).box({0, 0}, {size, size}, 1).build([](Lattice::Node) { return true; });
}

namespace {

bool in_middle(Lattice::Node cell) {
  return cell[0] >= 2 && cell[0] < 4 && cell[1] >= 2 && cell[1] < 4;
}

}  // namespace

Problem block_with_hole() {
  return Lattice(6)
      .box({0, 0}, {6, 6}, 1)
      .box({2, 2}, {4, 4}, 2)
      .hole_seed_in_cell({3, 2})
      .build([](Lattice::Node cell) { return !in_middle(cell); });
}

Problem block_with_regions() {
  return Lattice(6)
      .box({0, 0}, {6, 6}, 1)
      .segment({0, 3}, {6, 3}, 3)
      .region_in_cell({1, 1}, 10)
      .region_in_cell({1, 4}, 20)
      .build([](Lattice::Node) { return true; },
             [](Lattice::Node cell) { return cell[1] < 3 ? 10 : 20; });
}

std::uint32_t vertex(const Mesh& mesh, Vec2 p) {
  const auto found = std::find(mesh.vertices.begin(), mesh.vertices.end(), p);
  if (found == mesh.vertices.end()) throw std::logic_error("no such vertex");
  return static_cast<std::uint32_t>(found - mesh.vertices.begin());
}

std::size_t listed_edge(const Mesh& mesh, Vec2 p, Vec2 q) {
  const std::uint32_t a = vertex(mesh, p), b = vertex(mesh, q);
  for (std::size_t i = 0; i < mesh.edges.size(); ++i)
    if ((mesh.edges[i].a == a && mesh.edges[i].b == b) ||
        (mesh.edges[i].a == b && mesh.edges[i].b == a))
      return i;
  throw std::logic_error("no such listed edge");
}

std::size_t triangle(const Mesh& mesh, Vec2 p, Vec2 q, Vec2 r) {
  const std::set<std::uint32_t> wanted = {vertex(mesh, p), vertex(mesh, q), vertex(mesh, r)};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (std::set<std::uint32_t>(mesh.triangles[t].begin(), mesh.triangles[t].end()) == wanted)
      return t;
  throw std::logic_error("no such triangle");
}

void remove_triangle(Mesh& mesh, std::size_t t) {
  mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(t));
  if (!mesh.regions.empty())
    mesh.regions.erase(mesh.regions.begin() + static_cast<std::ptrdiff_t>(t));
  for (auto v = static_cast<std::uint32_t>(mesh.vertices.size()); v-- > 0;) {
    const auto has = [v](const auto& corners) {
      return std::find(corners.begin(), corners.end(), v) != corners.end();
    };
    if (std::any_of(mesh.triangles.begin(), mesh.triangles.end(), has)) continue;
    mesh.vertices.erase(mesh.vertices.begin() + v);
    for (auto& corners : mesh.triangles)
      for (std::uint32_t& corner : corners) corner -= corner > v;
    std::erase_if(mesh.edges, [v](const Mesh::Edge& e) { return e.a == v || e.b == v; });
    for (Mesh::Edge& edge : mesh.edges) {
      edge.a -= edge.a > v;
      edge.b -= edge.b > v;
    }
  }
}

}  // namespace weft::check::testing
