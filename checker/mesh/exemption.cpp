// SPDX-License-Identifier: Apache-2.0
#include "checker/mesh/exemption.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace weft::check {
namespace {

constexpr double kCosine60 = 0.5 - 1e-9;
constexpr double kSameDistance = 0x1p-46;  // over the largest coordinate

// Whether p and q are seen from v at less than 60 degrees.
bool below_60_degrees(Vec2 v, Vec2 p, Vec2 q) {
  const double ux = p.x - v.x, uy = p.y - v.y;
  const double wx = q.x - v.x, wy = q.y - v.y;
  return ux * wx + uy * wy > kCosine60 * std::hypot(ux, uy) * std::hypot(wx, wy);
}

// The pairs with this first number.
std::span<const SegmentsOfVertices::value_type> entries(const SegmentsOfVertices& pairs,
                                                        std::uint32_t first) {
  const auto begin = std::lower_bound(pairs.begin(), pairs.end(), std::pair{first, 0u});
  const auto end =
      std::find_if(begin, pairs.end(), [&](const auto& p) { return p.first != first; });
  return {begin, end};
}

}  // namespace

SmallInputAngles::SmallInputAngles(const Mesh& mesh, const ListedEdges& listed,
                                   SegmentsOfVertices segments)
    : mesh_(mesh), listed_(listed), segments_(std::move(segments)) {
  for (const Vec2 p : mesh.vertices)
    same_distance_ = std::max({same_distance_, std::fabs(p.x), std::fabs(p.y)});
  same_distance_ *= kSameDistance;
  vertices_.reserve(segments_.size());
  for (const auto& [vertex, segment] : segments_) vertices_.emplace_back(segment, vertex);
  std::sort(vertices_.begin(), vertices_.end());
}

Exemption SmallInputAngles::exemption(std::uint32_t triangle, std::uint32_t corner) const {
  const std::uint32_t next = (corner + 1) % 3, previous = (corner + 2) % 3;
  const auto& vertices = mesh_.triangles[triangle];
  const std::uint32_t p = vertices[next], q = vertices[previous];
  if (listed_.listed[3 * triangle + corner] && listed_.listed[3 * triangle + previous] &&
      below_60_degrees(mesh_.vertices[vertices[corner]], mesh_.vertices[p], mesh_.vertices[q]))
    return Exemption::kCorner;
  return on_shell(p, q) ? Exemption::kShell : Exemption::kNone;
}

// Whether p and q are at the same distance from v, and seen from there at less than 60 degrees.
bool SmallInputAngles::is_shell(Vec2 v, Vec2 p, Vec2 q) const {
  const double to_p = std::hypot(p.x - v.x, p.y - v.y);
  const double to_q = std::hypot(q.x - v.x, q.y - v.y);
  return to_p > 0 && std::fabs(to_p - to_q) <= same_distance_ && below_60_degrees(v, p, q);
}

bool SmallInputAngles::on_shell(std::uint32_t p, std::uint32_t q) const {
  const Vec2 at_p = mesh_.vertices[p], at_q = mesh_.vertices[q];
  for (const auto& [of_p, s] : entries(segments_, p)) {
    for (const auto& [of_q, t] : entries(segments_, q)) {
      if (s == t) continue;
      auto along_s = entries(vertices_, s), along_t = entries(vertices_, t);
      if (along_t.size() < along_s.size()) std::swap(along_s, along_t);
      for (const auto& [segment, corner] : along_s)
        if (std::binary_search(along_t.begin(), along_t.end(),
                               std::pair{along_t.front().first, corner}) &&
            is_shell(mesh_.vertices[corner], at_p, at_q))
          return true;
    }
  }
  return false;
}

}  // namespace weft::check
