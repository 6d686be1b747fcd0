// SPDX-License-Identifier: Apache-2.0
// The star of a point to be inserted: grows its cavity, holds the badness of its triangles, and
// puts them into the mesh (refiner.h has a picture).
//
//   if (star.grow_from_triangle(t, p, lens) == Growth::kComplete) {
//     area.judge(star.ring(), 0, star.ring().size, p, bound, quality, star.judged());
//     star.make(mesh, slots, slots.add_vertex(mesh, p), true, queue);
//   }
//
// The mesh does not change before `make`, so a point may be tried and discarded. Not thread-safe:
// one per task.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/base/geometry.h"
#include "engine/refine/cavity.h"
#include "engine/refine/storage/mesh_store.h"
#include "engine/refine/storage/slots.h"

namespace weft {

template <class Ownership>
class Star {
 public:
  using Growth = typename Cavity<Ownership>::Growth;

  explicit Star(const MeshStore& mesh) : cavity_(mesh), judged_(kInitialRing) {}

  // Begins a task that owns the slots of `owner`.
  void begin(const Ownership& ownership, std::uint32_t owner) { cavity_.begin(ownership, owner); }

  // As in Cavity, but these make room: they never return kOverflow.
  Growth grow_from_triangle(std::uint32_t seed, Point p, double lens) {
    Growth growth;
    while ((growth = cavity_.grow_from_triangle(seed, p, lens)) == Growth::kOverflow)
      [[unlikely]] enlarge();
    return growth;
  }
  Growth grow_from_segment(std::uint32_t triangle, std::uint32_t edge, Point p,
                           bool across_stays = false) {
    Growth growth;
    while ((growth = cavity_.grow_from_segment(triangle, edge, p, across_stays)) ==
           Growth::kOverflow)
      [[unlikely]] enlarge();
    return growth;
  }

  Growth grow_beyond(std::uint32_t triangle, std::uint32_t edge, Point p) {
    return cavity_.grow_beyond(triangle, edge, p);
  }

  const Ring& ring() const { return cavity_.ring(); }
  const Cavity<Ownership>& cavity() const { return cavity_; }
  // The badness of the triangle at each edge of the ring; there is room for all.
  Badness* judged() { return judged_.data(); }

  // Replaces the cavity by the star of its point, now a vertex, and calls queue(triangle, badness,
  // edge) for its bad triangles, with the edge of the ring. Returns how many triangles the mesh has
  // gained. REQUIRES: the star has been judged.
  //
  // Uses one loop, and the slots of the cavity stay in place, because processors mispredict the end
  // of each loop over a ring. That saved an eighth of the mispredictions in a simulated predictor.
  template <class Queue>
  std::int64_t make(MeshStore& mesh, Slots& slots, std::uint32_t vertex, bool closed, Queue queue) {
    Triangle* const triangles = mesh.triangles.data();
    const std::uint32_t n = ring().size;
    const std::uint32_t region = triangles[cavity_.triangles()[0]].region;
    const std::uint32_t* const __restrict star = take_slots(mesh, slots);
    const Badness* const __restrict judged = judged_.data();
    const RingPoint* const __restrict points = ring().points.data();

    HalfEdge previous = half_edge(star[n - 1], 1);
    std::uint32_t start = points[0].vertex;
    for (std::uint32_t i = 0; i < n; ++i) {
      const RingPoint& end = points[i + 1];
      Triangle& t = triangles[star[i]];
      t.vertex[0] = vertex;
      t.vertex[1] = start;
      t.vertex[2] = end.vertex;
      t.flags = end.constrained | judged[i] << 8;
      t.neighbor[0] = end.outside;
      t.neighbor[1] = half_edge(star[i + 1], 2);
      t.neighbor[2] = previous;
      t.region = region;
      if (end.outside != kNone) [[likely]] {
        triangles[triangle_of(end.outside)].neighbor[edge_of(end.outside)] = half_edge(star[i], 0);
      }
      if (judged[i] != kGood) queue(star[i], judged[i], i);
      start = end.vertex;
      previous = half_edge(star[i], 1);
    }
    if (!closed) {
      triangles[star[0]].neighbor[2] = kNone;
      triangles[star[n - 1]].neighbor[1] = kNone;
    }
    return static_cast<std::int64_t>(n) - cavity_.size();
  }

  // Marks the two pieces of a segment, after a star was made around a point on it; each side keeps
  // its region. The ring's first `near_side` edges are on one side.
  void mark_segment(MeshStore& mesh, std::uint32_t near_side, bool closed,
                    std::uint32_t near_region, std::uint32_t far_region) {
    Triangle* const triangles = mesh.triangles.data();
    const std::uint32_t* const star = cavity_.triangles();
    const std::uint32_t n = ring().size;
    triangles[star[0]].flags |= 1u << 2;
    triangles[star[near_side - 1]].flags |= 1u << 1;
    if (closed) {
      triangles[star[near_side]].flags |= 1u << 2;
      triangles[star[n - 1]].flags |= 1u << 1;
    }
    for (std::uint32_t i = 0; i < n; ++i)
      triangles[star[i]].region = i < near_side ? near_region : far_region;
  }

  std::uint64_t exact_predicates() const { return cavity_.exact_predicates(); }
  std::uint64_t bytes() const { return cavity_.bytes() + judged_.capacity() * sizeof(judged_[0]); }

 private:
  static constexpr std::size_t kInitialRing = 1024;

  void enlarge() {
    cavity_.enlarge();
    judged_.resize(2 * judged_.size());
  }

  // The slots for the star: those of the cavity that are this task's, then new ones. The first is
  // repeated after the last.
  const std::uint32_t* take_slots(MeshStore& mesh, Slots& slots) {
    const std::uint32_t n = ring().size;
    std::uint32_t* const star = cavity_.triangles();
    const std::uint32_t taken =
        cavity_.in_own_slots() ? cavity_.size() : drop_foreign_slots(mesh, slots.owner());
    slots.add_triangles(mesh, n - taken, star + taken);
    star[n] = star[0];
    return star;
  }

  // Moves the cavity's slots of this task to the front, and returns their number. The triangles in
  // the others die.
  [[gnu::noinline]] std::uint32_t drop_foreign_slots(MeshStore& mesh, std::uint32_t owner) {
    std::uint32_t* const first = cavity_.triangles();
    std::uint32_t* const own = std::remove_if(first, first + cavity_.size(), [&](std::uint32_t t) {
      const bool foreign = mesh.owner_of_triangle(t) != owner;
      if (foreign) mesh.triangles[t].die();
      return foreign;
    });
    return static_cast<std::uint32_t>(own - first);
  }

  Cavity<Ownership> cavity_;
  std::vector<Badness> judged_;
};

}  // namespace weft
