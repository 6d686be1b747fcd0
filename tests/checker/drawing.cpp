// SPDX-License-Identifier: Apache-2.0
#include "tests/checker/drawing.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>
#include <utility>

#include "checker/geometry/predicates.h"

namespace weft::check::testing {
namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;

Pair sorted(std::uint32_t a, std::uint32_t b) {
  return std::minmax(a, b);
}

std::uint32_t place_of(std::vector<Vec2>& places, Vec2 at) {
  for (std::uint32_t i = 0; i < places.size(); ++i)
    if (std::hypot(places[i].x - at.x, places[i].y - at.y) < 1e-9) return i;
  places.push_back(at);
  return static_cast<std::uint32_t>(places.size() - 1);
}

// All edges of some triangulation that has the given ones.
std::set<Pair> greedy_edges(const Mesh& mesh) {
  const std::vector<Vec2>& at = mesh.vertices;
  std::set<Pair> edges;
  for (const Mesh::Edge& edge : mesh.edges) edges.insert(sorted(edge.a, edge.b));
  std::vector<Pair> pairs;
  for (std::uint32_t a = 0; a < at.size(); ++a)
    for (std::uint32_t b = a + 1; b < at.size(); ++b) pairs.emplace_back(a, b);
  std::stable_sort(pairs.begin(), pairs.end(), [&](Pair p, Pair q) {
    const auto length = [&](Pair e) {
      return std::hypot(at[e.first].x - at[e.second].x, at[e.first].y - at[e.second].y);
    };
    return length(p) < length(q);
  });
  for (const auto& [a, b] : pairs) {
    bool is_free = true;
    for (std::uint32_t v = 0; v < at.size() && is_free; ++v)
      is_free = v == a || v == b || orientation(at[a], at[b], at[v]) != 0 ||
                std::hypot(at[a].x - at[v].x, at[a].y - at[v].y) +
                        std::hypot(at[b].x - at[v].x, at[b].y - at[v].y) >
                    std::hypot(at[a].x - at[b].x, at[a].y - at[b].y) * (1 + 1e-9);
    for (const auto& [c, d] : edges)
      is_free = is_free && (a == c || a == d || b == c || b == d ||
                            orientation(at[a], at[b], at[c]) == orientation(at[a], at[b], at[d]) ||
                            orientation(at[c], at[d], at[a]) == orientation(at[c], at[d], at[b]));
    if (is_free) edges.emplace(a, b);
  }
  return edges;
}

bool is_empty(const std::vector<Vec2>& at, const std::array<std::uint32_t, 3>& t) {
  for (std::uint32_t v = 0; v < at.size(); ++v)
    if (v != t[0] && v != t[1] && v != t[2] && orientation(at[t[0]], at[t[1]], at[v]) >= 0 &&
        orientation(at[t[1]], at[t[2]], at[v]) >= 0 && orientation(at[t[2]], at[t[0]], at[v]) >= 0)
      return false;
  return true;
}

std::vector<std::array<std::uint32_t, 3>> triangles_of(const std::vector<Vec2>& at,
                                                       const std::set<Pair>& edges) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const auto& [a, b] : edges)
    for (std::uint32_t c = b + 1; c < at.size(); ++c) {
      if (!edges.contains({a, c}) || !edges.contains({b, c})) continue;
      std::array<std::uint32_t, 3> t{a, b, c};
      const int turn = orientation(at[a], at[b], at[c]);
      if (turn < 0) std::swap(t[1], t[2]);
      if (turn != 0 && is_empty(at, t)) triangles.push_back(t);
    }
  return triangles;
}

}  // namespace

void make_delaunay(Mesh& mesh) {
  std::set<Pair> listed;
  for (const Mesh::Edge& edge : mesh.edges) listed.insert(sorted(edge.a, edge.b));
  for (bool flipped = true; flipped;) {
    flipped = false;
    std::map<Pair, std::pair<std::size_t, std::uint32_t>> sides;  // directed: triangle, apex
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& v = mesh.triangles[t];
        sides[{v[k], v[(k + 1) % 3]}] = {t, v[(k + 2) % 3]};
      }
    for (const auto& [edge, side] : sides) {
      const auto [a, b] = edge;
      const auto across = sides.find({b, a});
      if (across == sides.end() || listed.contains(sorted(a, b))) continue;
      const auto [t, c] = side;
      const auto [u, d] = across->second;
      const std::vector<Vec2>& at = mesh.vertices;
      if (in_circle(at[a], at[b], at[c], at[d]) <= 0) continue;
      mesh.triangles[t] = {a, d, c};
      mesh.triangles[u] = {d, b, c};
      flipped = true;
      break;
    }
  }
}

Vec2 on_circle(Vec2 centre, double radius, double degrees) {
  const double angle = degrees * (std::numbers::pi / 180);
  return {centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)};
}

std::uint32_t Drawing::point_at(Vec2 at) {
  return place_of(domain_.points, at);
}

std::uint32_t Drawing::vertex_at(Vec2 at) {
  return place_of(mesh_.vertices, at);
}

void Drawing::segment(Vec2 from, Vec2 to, std::int32_t marker) {
  domain_.segments.push_back({point_at(from), point_at(to)});
  domain_.markers.push_back(marker);
}

Drawing& Drawing::line(const std::vector<Vec2>& through, std::int32_t marker) {
  segment(through.front(), through.back(), marker);
  for (std::size_t k = 1; k < through.size(); ++k)
    mesh_.edges.push_back({vertex_at(through[k - 1]), vertex_at(through[k]), marker});
  return *this;
}

Drawing& Drawing::arc(Vec2 centre, double radius, double from, double to, int pieces,
                      std::int32_t marker) {
  std::vector<double> degrees{from};
  for (int k = 1; k < pieces; ++k) degrees.push_back(from + (to - from) * k / pieces);
  degrees.push_back(to);
  const std::size_t before = mesh_.edges.size(), vertices = mesh_.vertices.size();
  arc(centre, radius, degrees, marker);
  if (pieces > 0) return *this;
  mesh_.edges.resize(before);
  mesh_.vertices.resize(vertices);
  return *this;
}

Drawing& Drawing::arc(Vec2 centre, double radius, const std::vector<double>& degrees,
                      std::int32_t marker) {
  const double turn = (degrees.back() - degrees.front()) * (std::numbers::pi / 180);
  domain_.arcs.push_back({static_cast<std::uint32_t>(domain_.segments.size()), std::tan(turn / 4)});
  std::vector<Vec2> through;
  for (const double each : degrees) through.push_back(on_circle(centre, radius, each));
  return line(through, marker);
}

Drawing& Drawing::unmeshed_line(Vec2 from, Vec2 to) {
  segment(from, to, 0);
  return *this;
}

Drawing& Drawing::vertex(Vec2 at) {
  vertex_at(at);
  return *this;
}

Drawing& Drawing::hole(Vec2 at) {
  domain_.holes.push_back(at);
  return *this;
}

Drawing& Drawing::region(Vec2 at, std::int32_t id) {
  domain_.regions.push_back({at, id, std::nullopt});
  return *this;
}

Drawing& Drawing::fill(Fill fill) {
  domain_.fill = fill;
  return *this;
}

Problem Drawing::mesh(const std::function<bool(Vec2)>& keep,
                      const std::function<std::int32_t(Vec2)>& region) const {
  Problem problem{domain_, mesh_, {}};
  Mesh& mesh = problem.mesh;
  const auto centroid = [&](const std::array<std::uint32_t, 3>& t) {
    const Vec2 p = mesh.vertices[t[0]], q = mesh.vertices[t[1]], r = mesh.vertices[t[2]];
    return Vec2{(p.x + q.x + r.x) / 3, (p.y + q.y + r.y) / 3};
  };
  mesh.triangles = triangles_of(mesh.vertices, greedy_edges(mesh));
  make_delaunay(mesh);
  std::erase_if(mesh.triangles, [&](const auto& t) { return !keep(centroid(t)); });
  if (region)
    for (const auto& t : mesh.triangles) mesh.regions.push_back(region(centroid(t)));
  return problem;
}

std::uint32_t vertex_near(const Mesh& mesh, Vec2 p) {
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
    if (std::hypot(mesh.vertices[v].x - p.x, mesh.vertices[v].y - p.y) < 1e-6) return v;
  throw std::out_of_range("no vertex is there");
}

std::string sentences(const Report& report, Rule rule) {
  std::string all;
  for (const Violation& violation : report.violations)
    if (violation.rule == rule) all += violation.sentence + "\n";
  return all;
}

}  // namespace weft::check::testing
