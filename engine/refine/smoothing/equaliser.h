// SPDX-License-Identifier: Apache-2.0
// Equalises a mesh between the stages of its refinement (stages.h): vertices move to where the
// triangles around them are equally large for their bounds (star_cost.h).
//
//   Equaliser<OwnsAll, ConstantArea> equaliser(refinement, quality, ConstantArea(1e-3));
//   equaliser.begin(OwnsAll{}, box, domain.vertices.size(), 0);
//   std::optional<Error> stopped = equaliser.run(slots, 1.3, 2);   // two sweeps
//
// A vertex stays where it is where a lattice follows the size, because there triangles are as large
// as they may be; where the size jumps, because a bound at a centroid tells little there; and where
// it would lie in the diametral disk of a segment of its link. What else a move keeps is in
// vertex_star.h. A sweep visits the stars in the order of the slots, so the mesh depends only on
// the request.
//
// Errors: those of refinement (refine/refiner.h). Not thread-safe: one per task.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/context.h"
#include "engine/base/geometry.h"
#include "engine/refine/area_batch.h"
#include "engine/refine/area_bound.h"
#include "engine/refine/quality_bounds.h"
#include "engine/refine/refinement_context.h"
#include "engine/refine/smoothing/star_cost.h"
#include "engine/refine/smoothing/vertex_star.h"
#include "engine/refine/storage/mesh_store.h"
#include "engine/refine/storage/slots.h"
#include "engine/refine/storage/vertex_set.h"
#include "weft/error.h"

namespace weft {

template <class Ownership, class AreaBound>
class Equaliser {
 public:
  Equaliser(const RefinementContext& refinement, const QualityBounds& quality, AreaBound area)
      : mesh_(refinement.mesh),
        context_(refinement.context),
        star_(refinement, quality.eased(), std::move(area)),
        cost_(std::max(kMinSin2, static_cast<float>(quality.sin2))) {}

  // As VertexStar::begin.
  void begin(const Ownership& ownership, const Box& box, std::uint32_t first_free,
             std::uint32_t first_owner) {
    star_.begin(ownership, box, first_free, first_owner);
    touched_.clear();
  }

  // Sweeps over the vertices of the triangles in `slots`, where bounds have this slack.
  std::optional<Error> run(const Slots& slots, double slack, std::uint32_t sweeps) {
    slack_ = slack;
    for (std::uint32_t sweep = 0; sweep < sweeps; ++sweep) {
      seen_.clear();
      std::optional<Error> stopped = find_bounds(slots);
      slots.for_triangles([&](std::uint32_t first, std::uint32_t last) {
        if (!stopped) stopped = poll();
        for (std::uint32_t t = first; t < last && !stopped; ++t) {
          if (mesh_.triangles[t].dead()) continue;
          for (const std::uint32_t vertex : mesh_.triangles[t].vertex)
            if (star_.may_move(vertex) && seen_.add(vertex)) equalise({t, vertex}, slots.owner());
        }
      });
      if (stopped) return stopped;
    }
    return poll();
  }

  // The triangles of other owners around vertices that have moved, some of them more than once.
  const std::vector<std::uint32_t>& touched() const { return touched_; }

  std::uint64_t bytes() const {
    return touched_.capacity() * sizeof(touched_[0]) + bound_.capacity() * sizeof(bound_[0]) +
           seen_.bytes();
  }

 private:
  using Star = VertexStar<Ownership, AreaBound>;
  static_assert(StarCost::kMaxEdges == Star::kMaxEdges);

  static constexpr float kMinSin2 = 0.1786F;  // of 25 degrees

  std::optional<Error> poll() const {
    if (const auto& bad = star_.area().bad_size()) return bad_size_error(*bad);
    return context_.poll();
  }

  void equalise(typename Star::Corner corner, std::uint32_t owner) {
    const Point from = mesh_.vertices[corner.vertex];
    if (star_.area().fits_lattice(from) || !star_.find(corner)) return;
    const double* const bound = bounds_of_star(owner);
    if (star_.area().fits_region(bound[0], star_.region_bound()) || jumps(bound, star_.size()))
      return;
    cost_.begin(star_.size(), star_.mean_edge());
    for (std::uint32_t i = 0; i <= star_.size(); ++i) cost_.set_point(i, star_.x(i), star_.y(i));
    for (std::uint32_t i = 0; i < star_.size(); ++i) cost_.set_bound(i, bound[i]);
    const auto place = cost_.search();
    if (!place) return;
    std::array<double, Star::kMaxEdges> doubled{};
    for (std::uint32_t i = 0; i < star_.size(); ++i) doubled[i] = 2 * slack_ * bound[i];
    for (const double part : {1.0, 0.4}) {
      const Point to{from.x + part * place->x, from.y + part * place->y};
      if (star_.encroaches(to) || !star_.move(to, doubled.data())) continue;
      note(owner);
      return;
    }
  }

  // Finds the bounds at the centroids of the triangles in `slots`, as they are before a sweep.
  std::optional<Error> find_bounds(const Slots& slots) {
    bound_.resize(slots.triangle_slots());
    const auto keep = [this](std::uint32_t t, double, double bound) {
      bound_[mesh_.place_of_triangle(t)] = bound;
    };
    std::optional<Error> stopped;
    slots.for_triangles([&](std::uint32_t first, std::uint32_t last) {
      if (!stopped) stopped = poll();
      for (std::uint32_t t = first; t < last && !stopped; ++t)
        if (!mesh_.triangles[t].dead() && batch_.add(mesh_, t)) batch_.take(star_.area(), keep);
    });
    batch_.take(star_.area(), keep);
    return stopped;
  }

  // Those of the star; at its own centroids if some of it is another owner's.
  const double* bounds_of_star(std::uint32_t owner) {
    for (std::uint32_t i = 0; i < star_.size(); ++i) {
      const std::uint32_t t = star_.triangle(i);
      if (mesh_.owner_of_triangle(t) != owner) return star_.bounds();
      of_star_[i] = std::min(bound_[mesh_.place_of_triangle(t)], star_.region_bound());
    }
    return of_star_.data();
  }

  void note(std::uint32_t owner) {
    for (std::uint32_t i = 0; i < star_.size(); ++i)
      if (mesh_.owner_of_triangle(star_.triangle(i)) != owner)
        touched_.push_back(star_.triangle(i));
  }

  MeshStore& mesh_;
  ExecutionContext& context_;
  Star star_;
  StarCost cost_;
  double slack_ = 1;
  AreaBatch batch_;
  std::vector<double> bound_;  // per slot of the owner, before this sweep
  std::array<double, Star::kMaxEdges> of_star_{};
  VertexSet seen_;  // of this sweep
  std::vector<std::uint32_t> touched_;
};

}  // namespace weft
