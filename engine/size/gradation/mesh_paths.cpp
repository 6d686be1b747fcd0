// SPDX-License-Identifier: Apache-2.0
#include "engine/size/gradation/mesh_paths.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

namespace weft {

VertexTriangles::VertexTriangles(const FieldMesh& mesh)
    : first_(mesh.vertices.size() + 1), triangles_(3 * mesh.triangles.size()) {
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) ++first_[v + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t]) triangles_[next[v]++] = t;
}

MeshPaths::MeshPaths(FieldMesh& mesh, const VertexTriangles& triangles, double growth)
    : mesh_(mesh),
      triangles_(triangles),
      growth_(growth),
      apex_(mesh.vertices.size()),
      reached_(mesh.vertices.size(), false) {
  std::iota(apex_.begin(), apex_.end(), 0u);
}

double MeshPaths::turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
  const Point p = mesh_.vertices[a];
  const Point q = mesh_.vertices[b];
  const Point r = mesh_.vertices[c];
  return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
}

void MeshPaths::carry(std::uint32_t apex, std::uint32_t to) {
  const double value =
      mesh_.values[apex] + growth_ * std::sqrt(distance2(mesh_.vertices[apex], mesh_.vertices[to]));
  if (!(value < mesh_.values[to])) return;
  mesh_.values[to] = value;
  apex_[to] = apex;
  open_.emplace(value, to);
}

// The way from the apex of `near` to `to`, if it crosses the side from `near` to `far` and is on
// the same side of the vertices at which the way to `far` turns as `near` is.
void MeshPaths::carry_across(std::uint32_t near, std::uint32_t far, std::uint32_t to) {
  const std::uint32_t apex = apex_[near];
  if (apex == to || turn(apex, to, near) * turn(apex, to, far) > 0) return;
  for (std::uint32_t w = apex_[far]; w != apex && apex_[w] != w; w = apex_[w])
    if (w == near || !(turn(apex, w, to) * turn(apex, w, near) > 0)) return;
  carry(apex, to);
}

void MeshPaths::reach(std::uint32_t v) {
  reached_[v] = true;
  triangles_.around(v, [&](std::uint32_t triangle) {
    const auto& t = mesh_.triangles[triangle];
    for (unsigned k = 0; k < 3; ++k) {
      if (t[k] == v) continue;
      carry(v, t[k]);
      const std::uint32_t a = t[(k + 1) % 3];
      const std::uint32_t b = t[(k + 2) % 3];
      if (!reached_[a] || !reached_[b]) continue;
      carry_across(a, b, t[k]);
      carry_across(b, a, t[k]);
    }
  });
}

std::optional<Error> MeshPaths::run(const ExecutionContext& context) {
  constexpr std::size_t kPollInterval = 1 << 12;
  for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v)
    if (mesh_.values[v] < std::numeric_limits<double>::infinity())
      open_.emplace(mesh_.values[v], v);
  for (std::size_t i = 0; !open_.empty(); ++i) {
    if (i % kPollInterval == 0) {
      if (auto error = context.poll()) return error;
    }
    const auto [value, v] = open_.top();
    open_.pop();
    if (value == mesh_.values[v]) reach(v);
  }
  return std::nullopt;
}

}  // namespace weft
