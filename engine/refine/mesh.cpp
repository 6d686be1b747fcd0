// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/refine/mesh.h"

#include <algorithm>

namespace weft {

Result<Mesh> Mesh::from(const Domain& domain, std::uint64_t max_triangles,
                        double expected_triangles, const ExecutionContext& context) {
  constexpr double kWorthHugePages = 100'000;
  constexpr std::uint32_t kPollInterval = 1 << 16;
  const std::uint64_t initial = domain.triangles.size();
  if (initial > kMaxTriangles) {
    return fail(ErrorCode::kLimitExceeded, "domain",
                "the triangulation of the domain has " + std::to_string(initial) +
                    " triangles, more than " + std::to_string(kMaxTriangles));
  }
  Mesh mesh;
  mesh.triangle_capacity =
      static_cast<std::uint32_t>(std::clamp<std::uint64_t>(max_triangles, initial, kMaxTriangles));
  // Each insertion adds one vertex and one or two triangles (one only on the outer boundary).
  mesh.vertex_capacity =
      static_cast<std::uint32_t>(domain.vertices.size() + (mesh.triangle_capacity - initial) + 1);
  const bool huge_pages = expected_triangles > kWorthHugePages;

  auto triangles = VirtualArray<Triangle>::reserve(mesh.triangle_capacity, huge_pages);
  if (!triangles) return tl::unexpected(triangles.error());
  auto vertices = VirtualArray<Point>::reserve(mesh.vertex_capacity, huge_pages);
  if (!vertices) return tl::unexpected(vertices.error());
  mesh.triangles = std::move(*triangles);
  mesh.vertices = std::move(*vertices);

  std::copy(domain.vertices.begin(), domain.vertices.end(), mesh.vertices.data());
  mesh.vertex_count = static_cast<std::uint32_t>(domain.vertices.size());
  for (std::uint32_t t = 0; t < initial; ++t) {
    if (t % kPollInterval == 0) {
      if (auto error = context.poll()) return tl::unexpected(*error);
    }
    const Domain::Triangle& from = domain.triangles[t];
    Triangle& to = mesh.triangles[t];
    to.flags = 0;
    to.region = from.region;
    for (std::uint32_t i = 0; i < 3; ++i) {
      to.vertex[i] = from.vertex[i];
      to.neighbor[i] = kNone;
      if (from.subsegment[i] != kNone) to.flags |= 1u << i;
      if (from.neighbor[i] == kNone) continue;
      const Domain::Triangle& across = domain.triangles[from.neighbor[i]];
      for (std::uint32_t j = 0; j < 3; ++j) {
        if (across.vertex[kNext[j]] == from.vertex[kPrevious[i]] &&
            across.vertex[kPrevious[j]] == from.vertex[kNext[i]]) {
          to.neighbor[i] = half_edge(from.neighbor[i], j);
        }
      }
    }
  }
  mesh.triangle_count = static_cast<std::uint32_t>(initial);
  return mesh;
}

}  // namespace weft
