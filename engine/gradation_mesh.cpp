// SPDX-License-Identifier: Apache-2.0
#include "engine/gradation_mesh.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

#include "engine/refinement.h"
#include "engine/size/gradation/mesh_limit.h"
#include "engine/size/gradation/scaled_size.h"

namespace weft {
namespace {

// Takes the chunks of a mesh, and from them where lengths of edges grow from besides the size:
// segments with sizes of their own, and regions.
class GradationMesh final : public ChunkSink {
 public:
  // REQUIRES: the mesh is that of `request`, which outlives this.
  explicit GradationMesh(const MeshRequest& request);

  bool accept(Chunk&& chunk) override;

  // The run holds `held` bytes besides. Errors: those of the context.
  Result<MeshField> limit(const SizeFunction& size, std::uint64_t held,
                          const ExecutionContext& context) &&;

 private:
  void lower(std::uint32_t v, double to);

  const SizeSpec& size_;
  std::map<std::int32_t, double> region_edges_;  // by the id; the least of several
  FieldMesh mesh_;
};

GradationMesh::GradationMesh(const MeshRequest& request) : size_(request.size) {
  const auto add = [&](std::int32_t region, double max_area) {
    const double edge = SizeFunction::edge_of_area(max_area);
    const auto [known, added] = region_edges_.emplace(region, edge);
    if (!added) known->second = std::min(known->second, edge);
  };
  for (const RegionSeed& region : request.pslg.regions)
    if (region.max_area) add(region.id, *region.max_area);
  for (const Area& area : request.pslg.areas)
    if (area.region && area.max_area) add(*area.region, *area.max_area);
}

void GradationMesh::lower(std::uint32_t v, double to) {
  mesh_.values[v] = std::min(mesh_.values[v], to);
}

bool GradationMesh::accept(Chunk&& chunk) {
  for (std::size_t i = 0; i < chunk.coordinates.size(); i += 2)
    mesh_.vertices.push_back({chunk.coordinates[i], chunk.coordinates[i + 1]});
  mesh_.values.resize(mesh_.vertices.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < chunk.triangles.size(); i += 3)
    mesh_.triangles.push_back({chunk.triangles[i], chunk.triangles[i + 1], chunk.triangles[i + 2]});
  for (std::size_t t = 0; t < chunk.triangles.size() / 3; ++t) {
    const auto found = region_edges_.find(chunk.regions.empty() ? 0 : chunk.regions[t]);
    if (found == region_edges_.end()) continue;
    for (unsigned k = 0; k < 3; ++k) lower(chunk.triangles[3 * t + k], found->second);
  }
  for (const Chunk::Edge& edge : chunk.edges)
    for (const SizeAt& at : size_.at)
      if (at.marker == edge.marker)
        for (const std::uint32_t v : {edge.a, edge.b}) lower(v, at.max_edge);
  return true;
}

Result<MeshField> GradationMesh::limit(const SizeFunction& size, std::uint64_t held,
                                       const ExecutionContext& context) && {
  const std::uint64_t bytes = mesh_.vertices.capacity() * sizeof(Point) +
                              mesh_.values.capacity() * sizeof(double) +
                              mesh_.triangles.capacity() * sizeof(mesh_.triangles[0]) +
                              MeshField::bytes_to_make(mesh_.triangles.size());
  if (auto error = context.need_bytes(held + bytes, "the gradation within the domain"))
    return tl::unexpected(*error);
  if (auto error = lower_to_size(size, size_.gradation, mesh_, context))
    return tl::unexpected(*error);
  if (auto error = limit_slopes(size_.gradation, mesh_, context)) return tl::unexpected(*error);
  for (double& value : mesh_.values) value = std::min(value, SizeFunction::kUnreachedEdge);
  return MeshField::make(std::move(mesh_), "size.gradation", context);
}

// How long edges should be, as a share of what the gradation across land makes them. Above a
// gradation of 0.8, the mesh would have too many triangles.
double share_of_edges(double gradation) {
  return std::clamp(kResolution / gradation, 0.1, 1.5);
}

}  // namespace

Result<MeshField> limit_within(const MeshRequest& request, const Domain& domain,
                               const Domain& ground, const Box& box, const SizeFunction& across,
                               const SizeFunction& size, const ExecutionContext& context) {
  const double share = share_of_edges(request.size.gradation);
  MeshRequest finer;
  finer.min_edge = share * request.min_edge;
  finer.leaf_triangles = request.leaf_triangles;
  finer.sweeps = 0;
  finer.allow_unrefined = true;
  Budget budget = context.budget();
  budget.max_triangles = std::min(budget.max_triangles, budget.triangle_limit);
  ExecutionContext inside(context, budget);
  const ScaledSize scaled(across, share * share);
  const auto map = inside.compute([&] { return SizeMap::build(scaled, ground, inside); });
  if (!map) return tl::unexpected(map.error());
  GradationMesh mesh(request);
  StageClock clock;
  Summary summary;
  summary.box = box;
  const PeriodicSides none;
  const Refinable ready{finer, domain, ground, box, scaled, &*map, scaled.bytes(), none, nullptr};
  if (auto error = refine(ready, mesh, inside, clock, summary))
    return tl::unexpected(std::move(*error));
  return inside.compute(
      [&] { return std::move(mesh).limit(size, domain.bytes() + across.bytes(), context); });
}

}  // namespace weft
