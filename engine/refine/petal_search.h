// SPDX-License-Identifier: Apache-2.0
// The search of a petal (petal.h): the star of each place is grown and judged, and the place with
// the largest gain is kept. Some three places are tried for each skinny triangle. Nothing of the
// mesh changes. Not thread-safe: one per task.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/geometry.h"
#include "engine/refine/petal.h"
#include "engine/refine/quality_bounds.h"
#include "engine/refine/star.h"
#include "engine/refine/storage/mesh_store.h"
#include "engine/refine/triangle_judge.h"

namespace weft {

template <class Ownership>
class PetalSearch {
 public:
  struct Place {
    Point at;
    RingVerdict verdict;  // of the star there
  };

  explicit PetalSearch(const MeshStore& mesh) : mesh_(mesh), other_(mesh) {}

  // See Star::begin.
  void begin(const Ownership& ownership, std::uint32_t owner) { other_.begin(ownership, owner); }

  // Returns the best place, with its star in `star`. Before the call, `star` is that of the
  // standard place, grown and judged. `look_at(other, p)` grows and judges `other` at p, and
  // returns nullopt if p is not an admissible place.
  template <class LookAt>
  Place run(Star<Ownership>& star, const Petal& petal, const Place& standard,
            const QualityBounds& quality, LookAt&& look_at) {
    Place best = standard;
    Gain gain = gain_of(star, standard.verdict);
    const std::int32_t all_bad = bad_around(star);
    remember_ring(star);
    search_petal(quality, [&](double half_tangent) {
      if (gain.bad_removed >= all_bad) return false;
      const Point p = petal.place(half_tangent);
      if (petal.same_place(p, standard.at) || near_ring(p, petal.shortest2())) return false;
      const std::optional<RingVerdict> there = look_at(other_, p);
      if (!there || there->flat || there->too_close || there->nearest2 < petal.shortest2())
        return false;
      const Gain its = gain_of(other_, *there);
      if (!(its > gain)) return false;
      best = {p, *there};
      gain = its;
      std::swap(star, other_);
      return true;
    });
    return best;
  }

  std::uint64_t exact_predicates() const { return other_.exact_predicates(); }
  std::uint64_t bytes() const { return other_.bytes() + ring_.capacity() * sizeof(ring_[0]); }

 private:
  // What a place gains: first the fewer bad triangles, then the distance.
  struct Gain {
    std::int32_t bad_removed;  // triangles, less those that its star would have
    double nearest2;           // squared distance from the place to what it would be joined to

    bool operator>(const Gain& other) const {
      return bad_removed > other.bad_removed ||
             (bad_removed == other.bad_removed && nearest2 > other.nearest2);
    }
  };

  Gain gain_of(Star<Ownership>& star, const RingVerdict& verdict) const {
    std::int32_t removed = bad_in_cavity(star);
    for (std::uint32_t i = 0; i < star.ring().size; ++i) removed -= star.judged()[i] != kGood;
    return {removed, verdict.nearest2};
  }

  std::int32_t bad_in_cavity(const Star<Ownership>& star) const {
    const Cavity<Ownership>& cavity = star.cavity();
    return static_cast<std::int32_t>(
        std::count_if(cavity.triangles(), cavity.triangles() + cavity.size(),
                      [&](std::uint32_t t) { return mesh_.triangles[t].badness() != kGood; }));
  }

  // Counts bad triangles in the cavity and across the ring; few places have a larger value.
  std::int32_t bad_around(const Star<Ownership>& star) const {
    std::int32_t bad = bad_in_cavity(star);
    for (std::uint32_t i = 1; i <= star.ring().size; ++i) {
      const RingPoint& point = star.ring().points[i];
      if (point.constrained == 0)
        bad += mesh_.triangles[triangle_of(point.outside)].badness() != kGood;
    }
    return bad;
  }

  void remember_ring(const Star<Ownership>& star) {
    ring_.clear();
    for (std::uint32_t i = 0; i < star.ring().size; ++i)
      ring_.push_back(mesh_.vertices[star.ring().points[i].vertex]);
  }
  bool near_ring(Point p, double least2) const {
    return std::any_of(ring_.begin(), ring_.end(),
                       [&](Point q) { return distance2(p, q) < least2; });
  }

  const MeshStore& mesh_;
  Star<Ownership> other_;    // of the place being tried
  std::vector<Point> ring_;  // of the standard place
};

}  // namespace weft
