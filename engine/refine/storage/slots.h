// SPDX-License-Identifier: Apache-2.0
// The slots of one owner: the vertices and triangles that a refinement task makes. Vertices on
// segments have blocks of their own, for these remember their subsegment.
//
// An owner's slots, in the order in which it took them, are the same on every run, though the
// blocks may lie elsewhere: numbers and chunks in that order are deterministic.
//
// Errors: throws what MeshStore does if all blocks are taken. Not thread-safe: its owner's task
// uses it, and later who emits it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/base/simd.h"
#include "engine/refine/storage/mesh_store.h"

namespace weft {

class Slots {
 public:
  Slots() = default;
  explicit Slots(std::uint32_t owner) : owner_(owner) {}
  // Owner 0 with the triangles and vertices of MeshStore::from.
  static Slots of_domain(const Domain& domain);

  std::uint32_t owner() const { return owner_; }

  std::uint32_t add_triangle(MeshStore& mesh) {
    if (triangles_.next == triangles_.end) [[unlikely]] {
      const std::uint32_t first =
          mesh.take_triangle_block(owner_, static_cast<std::uint32_t>(triangle_blocks_.size()));
      triangle_blocks_.push_back(first);
      triangles_ = {first, first + MeshStore::kTriangleBlock};
    }
    return triangles_.next++;
  }
  // Takes slots for `count` triangles.
  void add_triangles(MeshStore& mesh, std::uint32_t count, std::uint32_t* slots) {
    if (count == 2 && triangles_.end - triangles_.next >= 2) [[likely]] {
      slots[0] = triangles_.next++;
      slots[1] = triangles_.next++;
      return;
    }
    for (std::uint32_t i = 0; i < count; ++i) slots[i] = add_triangle(mesh);
  }
  std::uint32_t add_vertex(MeshStore& mesh, Point p) {
    if (vertices_.next == vertices_.end) [[unlikely]]
      take_vertices(mesh, vertices_, false);
    store(mesh, vertices_.next, p);
    return vertices_.next++;
  }
  std::uint32_t add_segment_vertex(MeshStore& mesh, Point p, std::uint32_t subsegment) {
    if (on_segments_.next == on_segments_.end) take_vertices(mesh, on_segments_, true);
    store(mesh, on_segments_.next, p);
    mesh.subsegments[on_segments_.next] = subsegment;
    return on_segments_.next++;
  }

  // Calls f(first, last) for each run of slots in use, in order.
  template <class F>
  void for_triangles(F&& f) const {
    for (const std::uint32_t first : triangle_blocks_)
      f(first, used(first, MeshStore::kTriangleBlock, triangles_));
  }
  template <class F>
  void for_vertices(F&& f) const {
    for (const std::uint32_t first : vertex_blocks_) {
      const std::uint32_t last = used(first, MeshStore::kVertexBlock, vertices_);
      f(first, std::min(last, used(first, MeshStore::kVertexBlock, on_segments_)));
    }
  }

  std::uint32_t vertex_count() const;
  // The number of slots in use; some are dead.
  std::uint32_t triangle_slots() const;
  // Numbers the vertices in their order, from `first` on; returns the number after the last.
  std::uint32_t number_vertices(MeshStore& mesh, std::uint32_t first) const;

  // Gives back the triangles' blocks. REQUIRES: they have been sent, and nothing reads them any
  // more.
  void give_back_triangles(MeshStore& mesh) {
    mesh.give_back_triangles(triangle_blocks_);
    triangle_blocks_ = std::vector<std::uint32_t>();  // `= {}` would keep the memory
    triangles_ = {};
  }

  // Gives back the vertices' blocks. REQUIRES: they have been sent, and nothing reads them or their
  // numbers any more.
  void give_back_vertices(MeshStore& mesh) {
    mesh.give_back_vertices(vertex_blocks_);
    vertex_blocks_ = std::vector<std::uint32_t>();
    vertices_ = {};
    on_segments_ = {};
  }

  std::uint64_t bytes() const {
    return (triangle_blocks_.capacity() + vertex_blocks_.capacity()) * sizeof(std::uint32_t);
  }

 private:
  // The free slots of the block that was taken last.
  struct Free {
    std::uint32_t next = 0;
    std::uint32_t end = 0;
  };

  static std::uint32_t used(std::uint32_t first, std::uint32_t block, const Free& free) {
    return first + block == free.end ? free.next : first + block;
  }
  // Stores both coordinates at once, because the cavity reads them back at once.
  static void store(MeshStore& mesh, std::uint32_t vertex, Point p) {
    _mm_storeu_pd(&mesh.vertices[vertex].x, _mm_set_pd(p.y, p.x));
  }
  void take_vertices(MeshStore& mesh, Free& free, bool on_segment);

  std::uint32_t owner_ = 0;
  std::vector<std::uint32_t> triangle_blocks_;  // first slot of each, in the order taken
  std::vector<std::uint32_t> vertex_blocks_;
  Free triangles_;
  Free vertices_;
  Free on_segments_;
};

}  // namespace weft
