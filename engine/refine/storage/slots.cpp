// SPDX-License-Identifier: Apache-2.0
#include "engine/refine/storage/slots.h"

namespace weft {

Slots Slots::of_domain(const Domain& domain) {
  const auto blocks = [](std::size_t count, std::uint32_t block, std::vector<std::uint32_t>& firsts,
                         Free& free) {
    for (std::uint32_t first = 0; first < count; first += block) firsts.push_back(first);
    free = {static_cast<std::uint32_t>(count), static_cast<std::uint32_t>(firsts.size()) * block};
  };
  Slots slots(0);
  blocks(domain.triangles.size(), MeshStore::kTriangleBlock, slots.triangle_blocks_,
         slots.triangles_);
  blocks(domain.vertices.size(), MeshStore::kVertexBlock, slots.vertex_blocks_, slots.vertices_);
  return slots;
}

void Slots::take_vertices(MeshStore& mesh, Free& free, bool on_segment) {
  const std::uint32_t first = mesh.take_vertex_block(owner_, on_segment);
  vertex_blocks_.push_back(first);
  free = {first, first + MeshStore::kVertexBlock};
}

std::uint32_t Slots::vertex_count() const {
  std::uint32_t count = 0;
  for_vertices([&](std::uint32_t first, std::uint32_t last) { count += last - first; });
  return count;
}

std::uint32_t Slots::triangle_slots() const {
  std::uint32_t count = 0;
  for_triangles([&](std::uint32_t first, std::uint32_t last) { count += last - first; });
  return count;
}

std::uint32_t Slots::number_vertices(MeshStore& mesh, std::uint32_t first_number) const {
  std::uint32_t number = first_number;
  for_vertices([&](std::uint32_t first, std::uint32_t last) {
    mesh.vertex_blocks[first >> MeshStore::kVertexShift].number = number;
    number += last - first;
  });
  return number;
}

}  // namespace weft
