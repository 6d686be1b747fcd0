// SPDX-License-Identifier: Apache-2.0
#include "checker/mesh/periodic.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "checker/text.h"

namespace weft::check {
namespace {

struct Side {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;  // sorted, the mesh at their left
  std::vector<std::uint32_t> vertices;                         // sorted
  Vec2 mean{};
  Vec2 sum{};  // of the edges
};

Side side_of(const Mesh& mesh, const HalfEdges& half_edges, std::int32_t marker) {
  Side side;
  for (const Mesh::Edge& edge : mesh.edges) {
    if (edge.marker != marker) continue;
    const auto h = half_edges.find(edge.a, edge.b);
    if (h && !half_edges.has_twin(*h))
      side.edges.emplace_back(half_edges.start(*h), half_edges.end(*h));
  }
  std::sort(side.edges.begin(), side.edges.end());
  long double x = 0, y = 0, along_x = 0, along_y = 0;
  for (const auto& [a, b] : side.edges) {
    side.vertices.push_back(a);
    side.vertices.push_back(b);
    along_x += static_cast<long double>(mesh.vertices[b].x) - mesh.vertices[a].x;
    along_y += static_cast<long double>(mesh.vertices[b].y) - mesh.vertices[a].y;
  }
  std::sort(side.vertices.begin(), side.vertices.end());
  side.vertices.erase(std::unique(side.vertices.begin(), side.vertices.end()), side.vertices.end());
  for (const std::uint32_t v : side.vertices) {
    x += mesh.vertices[v].x;
    y += mesh.vertices[v].y;
  }
  const auto count = static_cast<long double>(side.vertices.size());
  side.mean = {static_cast<double>(x / count), static_cast<double>(y / count)};
  side.sum = {static_cast<double>(along_x), static_cast<double>(along_y)};
  return side;
}

// Vertices by their x, to be looked up by place.
class ByPlace {
 public:
  ByPlace(const Mesh& mesh, const std::vector<std::uint32_t>& vertices, double tolerance)
      : mesh_(mesh), vertices_(vertices), tolerance_(tolerance) {
    std::sort(vertices_.begin(), vertices_.end(), [&](std::uint32_t u, std::uint32_t v) {
      return key(mesh_.vertices[u]) < key(mesh_.vertices[v]);
    });
  }
  std::optional<std::uint32_t> at(Vec2 p) const {
    for (auto v = std::lower_bound(
             vertices_.begin(), vertices_.end(), key(p) - 2 * tolerance_,
             [&](std::uint32_t u, double k) { return key(mesh_.vertices[u]) < k; });
         v != vertices_.end() && key(mesh_.vertices[*v]) <= key(p) + 2 * tolerance_; ++v) {
      const Vec2 q = mesh_.vertices[*v];
      if (std::hypot(q.x - p.x, q.y - p.y) <= tolerance_) return *v;
    }
    return std::nullopt;
  }

 private:
  // Along a direction to which sides are rarely square.
  static double key(Vec2 p) { return 0.6 * p.x + 0.8 * p.y; }
  const Mesh& mesh_;
  std::vector<std::uint32_t> vertices_;
  const double tolerance_;
};

void judge_pair(const Mesh& mesh, const Side& from, const Side& to,
                const std::array<std::int32_t, 2>& markers, double tolerance, Findings& findings) {
  if (from.edges.empty() || from.edges.size() != to.edges.size() ||
      from.vertices.size() != to.vertices.size()) {
    findings.add(Rule::kPeriodic, [&] {
      return say("the sides with markers ", markers[0], " and ", markers[1], " have ",
                 from.edges.size(), " and ", to.edges.size(), " edges");
    });
    return;
  }
  // Opposite sums are no rotation: then nothing is rounded but the shift.
  const bool turns = std::hypot(from.sum.x + to.sum.x, from.sum.y + to.sum.y) > tolerance;
  const double scale = -1 / (std::hypot(from.sum.x, from.sum.y) * std::hypot(to.sum.x, to.sum.y));
  const double cosine = turns ? scale * (from.sum.x * to.sum.x + from.sum.y * to.sum.y) : 1;
  const double sine = turns ? scale * (from.sum.x * to.sum.y - from.sum.y * to.sum.x) : 0;
  const auto image = [&](Vec2 p) -> Vec2 {
    const double x = p.x - from.mean.x, y = p.y - from.mean.y;
    return {to.mean.x + (cosine * x - sine * y), to.mean.y + (sine * x + cosine * y)};
  };
  const ByPlace there(mesh, to.vertices, tolerance);
  const auto image_of = [&](std::uint32_t v) { return there.at(image(mesh.vertices[v])); };
  for (const std::uint32_t v : from.vertices) {
    if (image_of(v)) continue;
    findings.add(Rule::kPeriodic, [&] {
      return say("vertex ", v, " at ", mesh.vertices[v], " on the side with marker ", markers[0],
                 " has no image at ", image(mesh.vertices[v]), ", on the side with marker ",
                 markers[1]);
    });
  }
  for (const auto& [a, b] : from.edges) {
    const auto p = image_of(a), q = image_of(b);
    if (!p || !q || std::binary_search(to.edges.begin(), to.edges.end(), std::pair{*q, *p}))
      continue;
    findings.add(Rule::kPeriodic, [&, a = a, b = b] {
      return say("the edge from vertex ", a, " to vertex ", b, " on the side with marker ",
                 markers[0], " has no image on the side with marker ", markers[1]);
    });
  }
}

}  // namespace

void judge_periodic(const Mesh& mesh, const HalfEdges& half_edges,
                    const std::vector<std::array<std::int32_t, 2>>& pairs, double tolerance,
                    Findings& findings) {
  for (const auto& pair : pairs)
    judge_pair(mesh, side_of(mesh, half_edges, pair[0]), side_of(mesh, half_edges, pair[1]), pair,
               tolerance, findings);
}

}  // namespace weft::check
