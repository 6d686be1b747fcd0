// SPDX-License-Identifier: Apache-2.0
// The fragments of finished leaves (fragment.h): numbers their vertices, exports triangles, fills
// the fragments, and gives back the memory that is no longer read once they are built
// (leaf_release.h).
//
//   LeafFragments<ConstantArea> fragments(mesh, order, leaves, first_number, earlier_owners);
//   fragments.number_vertices(l);   // in the order of the leaves
//   fragments.export_triangles(l);
//   fragments.fill(l, builder);     // once the leaves that overlap l have exported theirs
//   fragments.built(l);
//
// Thread-safety: the steps may run in any order that LeafGraph permits, of different leaves at the
// same time; the rest only while no step runs.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/base/held_bytes.h"
#include "engine/emit/fragment.h"
#include "engine/emit/leaf_release.h"
#include "engine/parallel/leaf_order.h"
#include "engine/parallel/leaf_tasks.h"
#include "engine/refine/storage/mesh_store.h"
#include "engine/refine/storage/slots.h"

namespace weft {

template <class AreaBound>
class LeafFragments {
 public:
  // Numbers the leaves' vertices from `first_number` on. `earlier_owners` are in the order of their
  // leaves.
  LeafFragments(MeshStore& mesh, const LeafOrder& order, LeafTasks<AreaBound>& leaves,
                std::uint32_t first_number, std::vector<EarlierOwner> earlier_owners)
      : mesh_(mesh),
        order_(order),
        leaves_(leaves),
        earlier_owners_(std::move(earlier_owners)),
        release_(order),
        exported_(order.size()),
        numbers_(first_number) {}

  void number_vertices(std::uint32_t leaf) {
    for_slots(leaf, [&](const Slots& s) { numbers_ = s.number_vertices(mesh_, numbers_); });
  }
  // The number after the last vertex numbered so far.
  std::uint32_t numbers() const { return numbers_; }

  // Copies the triangles that go with other fragments.
  void export_triangles(std::uint32_t leaf) {
    auto& exported = exported_[leaf];
    exported = exported_triangles(mesh_, leaves_.slots(leaf));
    copies_.add(exported.capacity() * sizeof(ExportedTriangle));
  }

  void fill(std::uint32_t leaf, FragmentBuilder<AreaBound>& builder) const {
    const Slots& slots = leaves_.slots(leaf);
    std::size_t vertices = 0;
    for_slots(leaf, [&](const Slots& s) { vertices += s.vertex_count(); });
    builder.expect(vertices, slots.triangle_slots());
    for_slots(leaf, [&](const Slots& s) {
      s.for_vertices(
          [&](std::uint32_t first, std::uint32_t last) { builder.add_vertices(first, last); });
    });
    auto gone = exported_[leaf].cbegin();
    slots.for_triangles([&](std::uint32_t first, std::uint32_t last) {
      for (; gone != exported_[leaf].cend() && first <= gone->slot && gone->slot < last; ++gone) {
        builder.add_triangles(first, gone->slot);
        first = gone->slot + 1;
      }
      builder.add_triangles(first, last);
    });
    for (const std::uint32_t other : order_.overlapping(leaf)) {
      if (other > leaf) break;
      for (const ExportedTriangle& h : exported_[other]) {
        if (h.owner == slots.owner()) builder.add_triangle(h.triangle());
      }
    }
  }

  void built(std::uint32_t leaf) {
    leaves_.give_back_triangles(leaf);
    release_.fragment_built(
        leaf,
        [&](std::uint32_t a) {
          copies_.remove(exported_[a].capacity() * sizeof(ExportedTriangle));
          exported_[a] = std::vector<ExportedTriangle>();
        },
        [&](std::uint32_t b) { leaves_.give_back_vertices(b); });
  }

  // Keeps the vertices that the clean-up's triangles use, because these are sent last.
  void keep_vertices_of(const Slots& cleaned_up) {
    cleaned_up.for_triangles([&](std::uint32_t first, std::uint32_t last) {
      for (std::uint32_t t = first; t < last; ++t) {
        if (mesh_.triangles[t].dead()) continue;
        for (const std::uint32_t vertex : mesh_.triangles[t].vertex) {
          const std::uint32_t owner = mesh_.block_of_vertex(vertex).owner;
          if (owner >= leaves_.first_owner() && owner != cleaned_up.owner())
            release_.keep_vertices(owner - leaves_.first_owner());
        }
      }
    });
  }

  // Bytes at the peak.
  std::uint64_t bytes() const {
    return release_.bytes() + exported_.capacity() * sizeof(exported_[0]) + copies_.peak();
  }

 private:
  // Calls f for the owners whose vertices leave with the fragment of a leaf, in order.
  template <class F>
  void for_slots(std::uint32_t leaf, F&& f) const {
    auto earlier =
        std::lower_bound(earlier_owners_.begin(), earlier_owners_.end(), leaf,
                         [](const EarlierOwner& owner, std::uint32_t l) { return owner.leaf < l; });
    for (; earlier != earlier_owners_.end() && earlier->leaf == leaf; ++earlier) f(*earlier->slots);
    f(leaves_.slots(leaf));
  }

  MeshStore& mesh_;
  const LeafOrder& order_;
  LeafTasks<AreaBound>& leaves_;
  std::vector<EarlierOwner> earlier_owners_;  // by the leaf
  LeafRelease release_;
  std::vector<std::vector<ExportedTriangle>> exported_;  // per leaf
  HeldBytes copies_;
  std::uint32_t numbers_;
};

}  // namespace weft
