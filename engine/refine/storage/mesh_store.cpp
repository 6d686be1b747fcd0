// SPDX-License-Identifier: Apache-2.0
#include "engine/refine/storage/mesh_store.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>

#include "engine/base/failure.h"

namespace weft {
namespace {

// Builds with a sanitizer overwrite what is given back with a pattern whose coordinates are NaN. So
// a use after that is found, by its mesh or by ThreadSanitizer.
#ifdef WEFT_SPOILS_RETURNED
constexpr bool kSpoilsReturned = true;
#else
constexpr bool kSpoilsReturned = false;
#endif
constexpr int kGarbage = 0xff;

[[noreturn]] void throw_used_up(std::uint32_t slots) {
  throw Failure(
      {ErrorCode::kLimitExceeded, "size",
       "the mesh needs more than " + std::to_string(slots) +
           " triangles in memory at the same time, the most that there are numbers for; "
           "a mesh that leaves while it is refined needs a strip of it at a time, others, "
           "such as those with a minimum angle above 30 degrees, need all"});
}

constexpr std::uint32_t blocks_for(std::uint64_t count, std::uint32_t block) {
  return static_cast<std::uint32_t>((count + block - 1) / block);
}

// From the domain's triangle to the mesh's.
Triangle linked(const Domain& domain, const Domain::Triangle& from) {
  const auto last = static_cast<std::uint32_t>(domain.triangles.size() - 1);
  Triangle to{};
  to.region = from.region;
  for (std::uint32_t i = 0; i < 3; ++i) {
    to.vertex[i] = from.vertex[i];
    to.flags |= static_cast<std::uint32_t>(from.subsegment[i] != kNone) << i;
    // The same edge in the triangle across: the one before the corner where the edge ends, as seen
    // from here. Which of the three it is is hard to predict, so there is no branch on it.
    const std::uint32_t is_open = from.neighbor[i] == kNone;  // then another triangle stands in
    const Domain::Triangle& across = domain.triangles[std::min(from.neighbor[i], last)];
    const std::uint32_t end = from.vertex[kPrevious[i]];
    const std::uint32_t corner = 1 * static_cast<std::uint32_t>(across.vertex[1] == end) +
                                 2 * static_cast<std::uint32_t>(across.vertex[2] == end);
    to.neighbor[i] = half_edge(from.neighbor[i], kPrevious[corner]) | (0 - is_open);
  }
  return to;
}

}  // namespace

Result<MeshStore> MeshStore::from(const Domain& domain, std::uint64_t max_triangles,
                                  double expected_triangles, const ExecutionContext& context) {
  constexpr double kWorthHugePages = 100'000;
  constexpr std::uint32_t kPollInterval = 1 << 16;
  constexpr std::uint64_t kSlack = 1 << 22;  // slots that tasks leave unused, at least
  const std::uint64_t initial = domain.triangles.size();
  if (initial > kMaxTriangles) {
    return fail(ErrorCode::kLimitExceeded, "domain",
                "the triangulation of the domain has " + std::to_string(initial) +
                    " triangles, more than " + std::to_string(kMaxTriangles));
  }
  // The room takes address space only: twice the limit is far more than tasks leave unused.
  const std::uint64_t slots = std::min<std::uint64_t>(
      kMaxTriangles, 2 * std::clamp<std::uint64_t>(max_triangles, initial, kMaxTriangles) + kSlack);
  const Pages pages = expected_triangles > kWorthHugePages ? Pages::kHuge : Pages::kAny;
  MeshStore mesh;
  const auto triangle_blocks = static_cast<std::uint32_t>(slots >> kTriangleShift);
  // Each insertion adds one vertex and one or two triangles (one only on the outer boundary).
  const auto vertex_blocks = static_cast<std::uint32_t>(slots >> kVertexShift) +
                             blocks_for(domain.vertices.size(), kVertexBlock);
  const auto reserve = [](auto& array, std::size_t count, Pages kind) -> std::optional<Error> {
    auto reserved = std::remove_reference_t<decltype(array)>::reserve(count, kind);
    if (!reserved) return reserved.error();
    array = std::move(*reserved);
    return std::nullopt;
  };
  const std::size_t vertex_slots = std::size_t{vertex_blocks} * kVertexBlock;
  for (const auto& error :
       {reserve(mesh.triangles, std::size_t{triangle_blocks} * kTriangleBlock, pages),
        reserve(mesh.vertices, vertex_slots, pages),
        reserve(mesh.triangle_owner, triangle_blocks, Pages::kSmall),
        reserve(mesh.triangle_place, triangle_blocks, Pages::kSmall),
        reserve(mesh.vertex_blocks, vertex_blocks, Pages::kSmall),
        reserve(mesh.subsegments, vertex_slots, Pages::kSmall)}) {
    if (error) return tl::unexpected(*error);
  }

  // The first blocks belong to owner 0. The memory of owners is zero at first.
  const std::uint32_t first_blocks = blocks_for(initial, kTriangleBlock);
  mesh.triangle_pool = std::make_unique<BlockPool>(first_blocks, triangle_blocks);
  for (std::uint32_t b = 0; b < first_blocks; ++b) mesh.triangle_place[b] = b;
  mesh.vertex_pool =
      std::make_unique<BlockPool>(blocks_for(domain.vertices.size(), kVertexBlock), vertex_blocks);
  std::copy(domain.vertices.begin(), domain.vertices.end(), mesh.vertices.data());
  for (std::uint32_t t = 0; t < initial; ++t) {
    if (t % kPollInterval == 0) {
      if (auto error = context.poll()) return tl::unexpected(*error);
    }
    mesh.triangles[t] = linked(domain, domain.triangles[t]);
  }
  return mesh;
}

std::uint32_t MeshStore::take_triangle_block(std::uint32_t owner, std::uint32_t place) {
  const std::optional<std::uint32_t> block = triangle_pool->take();
  if (!block) throw_used_up(triangle_pool->capacity() << kTriangleShift);
  triangle_owner[*block] = owner;
  triangle_place[*block] = place;
  triangles.commit_ahead(*block << kTriangleShift);
  return *block << kTriangleShift;
}

std::uint32_t MeshStore::take_vertex_block(std::uint32_t owner, bool on_segment) {
  const std::optional<std::uint32_t> block = vertex_pool->take();
  if (!block) throw_used_up(triangle_pool->capacity() << kTriangleShift);
  vertex_blocks[*block] = {owner, 0, on_segment};
  vertices.commit_ahead(*block << kVertexShift);
  return *block << kVertexShift;
}

void MeshStore::give_back_triangles(const std::vector<std::uint32_t>& first_slots) {
  for (const std::uint32_t first : first_slots) {
    if (kSpoilsReturned)
      std::memset(static_cast<void*>(&triangles[first]), kGarbage,
                  kTriangleBlock * sizeof(Triangle));
    triangle_pool->give_back(first >> kTriangleShift);
  }
}

void MeshStore::give_back_vertices(const std::vector<std::uint32_t>& first_slots) {
  for (const std::uint32_t first : first_slots) {
    if (kSpoilsReturned) {
      std::memset(static_cast<void*>(&vertices[first]), kGarbage, kVertexBlock * sizeof(Point));
      std::memset(static_cast<void*>(&subsegments[first]), kGarbage,
                  kVertexBlock * sizeof(subsegments[0]));
      std::memset(static_cast<void*>(&vertex_blocks[first >> kVertexShift]), kGarbage,
                  sizeof(VertexBlock));
    }
    vertex_pool->give_back(first >> kVertexShift);
  }
}

std::uint64_t MeshStore::bytes() const {
  constexpr std::uint64_t kTriangles =
      kTriangleBlock * sizeof(Triangle) + 2 * sizeof(std::uint32_t);
  constexpr std::uint64_t kVertices = kVertexBlock * sizeof(Point) + sizeof(VertexBlock);
  return triangle_pool->peak() * kTriangles + vertex_pool->peak() * kVertices;
}

}  // namespace weft
