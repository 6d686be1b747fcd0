// SPDX-License-Identifier: Apache-2.0
#include "weft/weft.h"

#include <malloc.h>

#include <algorithm>
#include <new>

#include "engine/engine.h"
#include "engine/refine/storage/reserved_memory.h"

namespace weft {

constinit const std::string_view kEngineVersion = "19";

namespace {

// Puts the chunks together. Throws std::bad_alloc.
class Collector final : public ChunkSink {
 public:
  bool accept(Chunk&& chunk) override {
    for (std::size_t i = 0; i < chunk.coordinates.size(); i += 2)
      mesh.vertices.push_back({chunk.coordinates[i], chunk.coordinates[i + 1]});
    for (std::size_t i = 0; i < chunk.triangles.size(); i += 3)
      mesh.triangles.push_back(
          {chunk.triangles[i], chunk.triangles[i + 1], chunk.triangles[i + 2]});
    if (!chunk.regions.empty()) {
      mesh.regions.resize(chunk.first_triangle);  // of chunks in which every id is 0
      append(chunk.regions, mesh.regions);
    }
    if (!chunk.bulges.empty()) {
      mesh.bulges.resize(mesh.edges.size());  // of chunks in which all edges are straight
      append(chunk.bulges, mesh.bulges);
    }
    append(chunk.edges, mesh.edges);
    append(chunk.input_points, mesh.input_points);
    return true;
  }

  Mesh mesh;

 private:
  template <class T>
  static void append(const std::vector<T>& from, std::vector<T>& to) {
    to.insert(to.end(), from.begin(), from.end());
  }
};

}  // namespace

Result<Summary> stream(const MeshRequest& request, ChunkSink& sink, Run& run) {
  return generate_mesh(request, sink, run.context());
}

Result<Mesh> mesh(const MeshRequest& request, Run& run) {
  Collector collector;
  auto summary = stream(request, collector, run);
  if (!summary) return tl::unexpected(std::move(summary).error());
  if (!collector.mesh.regions.empty())
    collector.mesh.regions.resize(collector.mesh.triangles.size());
  if (!collector.mesh.bulges.empty()) collector.mesh.bulges.resize(collector.mesh.edges.size());
  collector.mesh.summary = std::move(*summary);
  return std::move(collector.mesh);
}

Result<Mesh> mesh(const MeshRequest& request) {
  Run run;
  return mesh(request, run);
}

// Each heap of malloc keeps at most a 128th of the bound at its end; vectors up to that size, and
// up to 4 MiB, come from it: us-east-coast without a size takes 8 % less time than with malloc's
// defaults, because the system clears 20 pages for it instead of 320.
void keep_memory_at_most(std::uint64_t bytes) {
  constexpr std::uint64_t kShare = 128;
  constexpr std::uint64_t kMaxOfHeap = std::uint64_t{16} << 20;
  constexpr std::uint64_t kMaxInHeap = std::uint64_t{4} << 20;  // larger vectors are mapped alone
  ReservedMemory::keep_at_most(bytes);
  mallopt(M_TRIM_THRESHOLD, static_cast<int>(std::min(bytes / kShare, kMaxOfHeap)));
  mallopt(M_MMAP_THRESHOLD, static_cast<int>(std::min(bytes / kShare, kMaxInHeap)));
}

}  // namespace weft
