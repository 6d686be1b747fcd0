// SPDX-License-Identifier: Apache-2.0
#include "checker/mesh/tangent_curves.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace weft::check {
namespace {

constexpr double kOneDirection = 1.001e-4;  // radians
constexpr double kReach = 1.0472;           // radians: 60 degrees

}  // namespace

TangentCurves::TangentCurves(const ArcChains& chains, const Mesh& mesh, const ListedEdges& listed)
    : chains_(chains), mesh_(mesh) {
  std::vector<Leaving> all;
  std::vector<char> is_chord(mesh.edges.size(), 0);
  for (std::uint32_t k = 0; k < chains.chords.size(); ++k) {
    const ArcChains::Chord& chord = chains.chords[k];
    const CircularArc& curve = *chains.curves[chord.segment];
    is_chord[chord.edge] = 1;
    chord_of_.emplace_back(chord.edge, k);
    const Vec2 u = curve.tangent(chord.from_angle), v = curve.tangent(chord.to_angle);
    all.push_back({chord.from, chord.segment, u, chord.from_angle, true});
    all.push_back({chord.to, chord.segment, {-v.x, -v.y}, chord.to_angle, false});
  }
  std::sort(chord_of_.begin(), chord_of_.end());
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (!listed.half_edge[e] || is_chord[e]) continue;
    const auto [a, b, marker] = mesh.edges[e];
    const Vec2 p = mesh.vertices[a], q = mesh.vertices[b];
    const double length = std::hypot(q.x - p.x, q.y - p.y);
    const Vec2 u{(q.x - p.x) / length, (q.y - p.y) / length};
    all.push_back({a, kStraight, u, 0, true});
    all.push_back({b, kStraight, {-u.x, -u.y}, 0, true});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Leaving& l, const Leaving& m) { return l.vertex < m.vertex; });
  for (std::size_t first = 0, end = 0; first < all.size(); first = end) {
    while (end < all.size() && all[end].vertex == all[first].vertex) ++end;
    for (std::size_t i = first; i < end; ++i)
      for (std::size_t j = first; j < end; ++j) {
        const Leaving &arc = all[i], &other = all[j];
        if (arc.segment == kStraight || arc.segment == other.segment) continue;
        const Vec2 u = arc.direction, v = other.direction;
        if (u.x * v.x + u.y * v.y > 0 && std::fabs(u.x * v.y - u.y * v.x) < kOneDirection)
          pairs_.push_back({arc, other});
      }
  }
  std::stable_sort(pairs_.begin(), pairs_.end(),
                   [](const Pair& p, const Pair& q) { return p.arc.segment < q.arc.segment; });
}

bool TangentCurves::holds(const Leaving& leaving, double from_angle, double to_angle) {
  constexpr double kRounding = 1e-9;
  const double from = from_angle - leaving.angle, to = to_angle - leaving.angle;
  return leaving.forward ? from >= -kRounding && to <= kReach : to <= kRounding && from >= -kReach;
}

bool TangentCurves::is_on_line(const Leaving& leaving, std::uint32_t vertex) const {
  const Vec2 at = mesh_.vertices[leaving.vertex], p = mesh_.vertices[vertex], u = leaving.direction;
  const double x = p.x - at.x, y = p.y - at.y;
  return std::fabs(u.x * y - u.y * x) <= chains_.tolerance && u.x * x + u.y * y >= 0;
}

// is_on(other): whether what is asked for belongs to the other curve.
template <class IsOn>
bool TangentCurves::any_other(const ArcChains::Chord& chord, IsOn&& is_on) const {
  auto pair = std::partition_point(pairs_.begin(), pairs_.end(),
                                   [&](const Pair& p) { return p.arc.segment < chord.segment; });
  for (; pair != pairs_.end() && pair->arc.segment == chord.segment; ++pair)
    if (holds(pair->arc, chord.from_angle, chord.to_angle) && is_on(pair->other)) return true;
  return false;
}

bool TangentCurves::have_edge(const ArcChains::Chord& chord, std::uint32_t edge) const {
  return any_other(chord, [&](const Leaving& other) {
    if (other.segment == kStraight)
      return is_on_line(other, mesh_.edges[edge].a) && is_on_line(other, mesh_.edges[edge].b);
    for (auto at = std::lower_bound(chord_of_.begin(), chord_of_.end(), std::pair{edge, 0u});
         at != chord_of_.end() && at->first == edge; ++at) {
      const ArcChains::Chord& of_edge = chains_.chords[at->second];
      if (of_edge.segment == other.segment && holds(other, of_edge.from_angle, of_edge.to_angle))
        return true;
    }
    return false;
  });
}

bool TangentCurves::have_vertex(const ArcChains::Chord& chord, std::uint32_t vertex) const {
  return any_other(chord, [&](const Leaving& other) {
    if (other.segment == kStraight) return is_on_line(other, vertex);
    const CircularArc& curve = *chains_.curves[other.segment];
    const Vec2 p = mesh_.vertices[vertex];
    return std::fabs(curve.distance(p)) <= chains_.tolerance &&
           holds(other, curve.angle(p), curve.angle(p));
  });
}

}  // namespace weft::check
