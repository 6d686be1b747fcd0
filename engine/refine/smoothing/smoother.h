// SPDX-License-Identifier: Apache-2.0
// Smoothing: once a task and its neighbours have nothing left to refine, vertices around small
// angles move to where the smallest angle around them is largest.
//
//   Smoother<OwnsAll, ConstantArea> smoother(refinement, quality, ConstantArea(1e-3));
//   smoother.begin(OwnsAll{}, box, domain.vertices.size(), 0);
//   std::optional<Error> stopped = smoother.run(slots, 2);   // two sweeps
//
// A lattice (lattice.h) makes nearly equilateral triangles, except in the rows where it meets
// a segment or another lattice. Nearly all angles below 45 degrees are in these rows, so that only
// a few vertices in a hundred have to move.
//
// A vertex of a triangle that is worth less than an angle of 48 degrees moves to the place that
// star_search.h finds best for its star. It stays where it is if that gains less than 1 %.
//
// A move keeps all bounds and the constrained Delaunay property (vertex_star.h). A sweep visits the
// stars in the order of the slots, so the mesh depends only on the request.
//
// Two sweeps raise the 1st percentile of the smallest angles by 2 to 5 degrees, for about 12 % more
// instructions (bench/README.md).
//
// Errors: those of refinement (refine/refiner.h). Not thread-safe: one per task.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/context.h"
#include "engine/base/geometry.h"
#include "engine/refine/area_bound.h"
#include "engine/refine/quality_bounds.h"
#include "engine/refine/refinement_context.h"
#include "engine/refine/smoothing/star_search.h"
#include "engine/refine/smoothing/vertex_star.h"
#include "engine/refine/storage/mesh_store.h"
#include "engine/refine/storage/slots.h"
#include "engine/refine/storage/vertex_set.h"
#include "weft/error.h"

namespace weft {

template <class Ownership, class AreaBound>
class Smoother {
 public:
  Smoother(const RefinementContext& refinement, const QualityBounds& quality, AreaBound area)
      : mesh_(refinement.mesh),
        context_(refinement.context),
        star_(refinement, quality, std::move(area)) {}

  // As VertexStar::begin.
  void begin(const Ownership& ownership, const Box& box, std::uint32_t first_free,
             std::uint32_t first_owner) {
    star_.begin(ownership, box, first_free, first_owner);
  }

  // Smooths the stars of the triangles in `slots`. Errors: kBadSizeValue at a centroid that a move
  // would make, kCancelled, kDeadlineExceeded.
  std::optional<Error> run(const Slots& slots, std::uint32_t sweeps) {
    next_.clear();
    seen_.clear();
    slots.for_triangles([&](std::uint32_t first, std::uint32_t last) {
      for (std::uint32_t t = first; t < last; ++t) {
        const Triangle& triangle = mesh_.triangles[t];
        if (!triangle.dead() && poor(triangle)) [[unlikely]]
          queue_corners(t);
      }
    });
    for (std::uint32_t sweep = 0; sweep < sweeps && !next_.empty(); ++sweep) {
      std::swap(now_, next_);
      next_.clear();
      seen_.clear();
      for (std::size_t i = 0; i < now_.size(); ++i) {
        smooth(now_[i], sweep + 1 < sweeps);
        if (i % kPollInterval == 0) {
          if (auto stopped = poll()) return stopped;
        }
      }
    }
    return poll();
  }

  std::uint64_t bytes() const {
    return (now_.capacity() + next_.capacity()) * sizeof(Corner) + seen_.bytes();
  }

 private:
  using Corner = typename VertexStar<Ownership, AreaBound>::Corner;
  static_assert(StarSearch::kMaxEdges == VertexStar<Ownership, AreaBound>::kMaxEdges);

  static constexpr double kPoor = StarSearch::kGoodEnough;
  static constexpr float kMinGain = 1.01F;
  static constexpr std::size_t kPollInterval = 256;  // stars

  std::optional<Error> poll() const {
    if (const auto& bad = star_.area().bad_size()) return bad_size_error(*bad);
    return context_.poll();
  }

  // Whether a triangle is worth less than kPoor; true if it has an obtuse angle.
  bool poor(const Triangle& t) const {
    const Point a = mesh_.vertices[t.vertex[0]];
    const Point b = mesh_.vertices[t.vertex[1]];
    const Point c = mesh_.vertices[t.vertex[2]];
    const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    const double ab2 = distance2(a, b);
    const double bc2 = distance2(b, c);
    const double ca2 = distance2(c, a);
    return area * area * std::min(std::min(ab2, bc2), ca2) < kPoor * (ab2 * bc2 * ca2);
  }

  void queue_corners(std::uint32_t t) {
    for (const std::uint32_t vertex : mesh_.triangles[t].vertex) {
      if (star_.may_move(vertex) && seen_.add(vertex)) next_.push_back({t, vertex});
    }
  }

  // Moves a vertex if that gains anything. `again`: keep triangles that stay poor for the next
  // sweep.
  void smooth(Corner corner, bool again) {
    if (!star_.find(corner)) return;
    begin_search();
    const StarSearch::Place best = search_.search();
    const Point centre = star_.centre();
    if (best.gain > kMinGain) star_.move({centre.x + best.x, centre.y + best.y});
    for (std::uint32_t i = 0; again && i < star_.size(); ++i) {
      if (poor(mesh_.triangles[star_.triangle(i)])) queue_corners(star_.triangle(i));
    }
  }

  void begin_search() {
    const double* const bound = star_.bounds();
    search_.begin(star_.size(), star_.mean_edge());
    for (std::uint32_t i = 0; i <= star_.size(); ++i) search_.set_point(i, star_.x(i), star_.y(i));
    for (std::uint32_t i = 0; i < star_.size(); ++i) search_.set_bound(i, bound[i]);
  }

  MeshStore& mesh_;
  ExecutionContext& context_;
  VertexStar<Ownership, AreaBound> star_;
  StarSearch search_;
  std::vector<Corner> now_;   // of this sweep
  std::vector<Corner> next_;  // and of the next, whose vertices are in `seen_`
  VertexSet seen_;
};

}  // namespace weft
