// SPDX-License-Identifier: Apache-2.0
// Fills what is clear in a leaf with rows of lattice triangles (lattice_rows.h), before refinement
// inserts the rest point by point.
//
//   RowFiller<ConstantArea> filler(refinement, quality, area);
//   refiner.begin(slots, ownership, box);
//   filler.fill(refiner, slots, ownership, leaf, bad);     // then queue and run as ever
//
// A part is clear if its bound is one value, and no segment of a bad triangle of the leaf comes
// within two spacings. Neighbours that went first are refined already, so looking around in the
// mesh would take longer than what it saves. If the leaf is not clear, its
// quarters are tried, four levels deep, as long as they have kMin rows. What is missed, because
// a point of the ring comes too close to a vertex or some other segment is in the way, is refined
// as if there were no rows; the points of the ring are points that refinement would have placed.
//
// Thread-safety: one RowFiller per task.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/geometry.h"
#include "engine/base/held_bytes.h"
#include "engine/refine/lattice_rows.h"
#include "engine/refine/ownership.h"
#include "engine/refine/quality_bounds.h"
#include "engine/refine/refinement_context.h"
#include "engine/refine/refiner.h"
#include "engine/refine/steiner_point.h"
#include "engine/refine/storage/mesh_store.h"
#include "engine/refine/storage/slots.h"
#include "engine/size/lattice/lattice.h"

namespace weft {

template <class AreaBound>
class RowFiller {
 public:
  using LeafRefiner = Refiner<OwnsBox, AreaBound>;

  // REQUIRES: `area` outlives this.
  RowFiller(const RefinementContext& refinement, const QualityBounds& quality,
            const AreaBound& area)
      : mesh_(refinement.mesh),
        regions_(refinement.regions),
        quality_(quality),
        area_(area),
        held_(refinement.context.held_bytes(), 0),
        rows_(refinement.mesh) {}

  // Fills what it can of `box`. `bad` are bad triangles in and around it: some may no longer exist.
  // REQUIRES: the refiner has begun the task of `slots` and `ownership`.
  void fill(LeafRefiner& refiner, Slots& slots, const OwnsBox& ownership, const Box& box,
            const std::vector<BadTriangle>& bad) {
    if (!quality_.lattice.exists()) return;
    rows_.begin(slots, ownership);
    refiner_ = &refiner;
    bad_ = &bad;
    start_ = kNone;
    near_segments_.clear();
    for (const BadTriangle& b : bad) {
      if (is_current(b)) add_segments(mesh_.triangles[b.triangle]);
    }
    fill_part(box, 0);
    held_.grow_to(bytes());
  }

  std::uint64_t bytes() const {
    return rows_.bytes() + near_segments_.capacity() * sizeof(near_segments_[0]);
  }

 private:
  static constexpr int kDeepest = 4;
  static constexpr double kClear = 2;  // spacings from a segment
  using Ends = std::pair<Point, Point>;

  bool is_current(const BadTriangle& b) const {
    const Triangle& t = mesh_.triangles[b.triangle];
    return t.vertex[0] == b.first_vertex && rows_.owns(b.triangle) && !t.dead();
  }

  void add_segments(const Triangle& t) {
    for (std::uint32_t i = 0; i < 3; ++i) {
      if (t.on_segment(i))
        near_segments_.push_back(
            {mesh_.vertices[t.vertex[kNext[i]]], mesh_.vertices[t.vertex[kPrevious[i]]]});
    }
  }

  void fill_part(const Box& box, int depth) {
    if (refiner_->stopped()) return;
    if (const auto bound = area_.uniform_bound(box)) {
      const double spacing = std::sqrt(lattice_spacing2(*bound, quality_.lattice));
      if (!(spacing > 0) || makes_short_edges(spacing)) return;
      if (std::min(box.width(), box.height()) < LatticeRectangle::kMin * kRowRise * spacing) return;
      const auto rectangle = LatticeRectangle::in(box, spacing, quality_.lattice.jitter);
      if (rectangle && is_clear(box, kClear * spacing) && fill(*rectangle, *bound)) return;
    }
    if (depth == kDeepest) return;
    const double x = box.min_x + 0.5 * box.width();
    const double y = box.min_y + 0.5 * box.height();
    fill_part({box.min_x, box.min_y, x, y}, depth + 1);
    fill_part({x, box.min_y, box.max_x, y}, depth + 1);
    fill_part({box.min_x, y, x, box.max_y}, depth + 1);
    fill_part({x, y, box.max_x, box.max_y}, depth + 1);
  }

  // Whether edges of the lattice may be below the floor.
  bool makes_short_edges(double spacing) const {
    const double shortest = spacing * (1 - 3 * quality_.lattice.jitter);
    return !(shortest * shortest > quality_.min_length2);
  }

  bool is_clear(const Box& box, double margin) const {
    const Box around{box.min_x - margin, box.min_y - margin, box.max_x + margin,
                     box.max_y + margin};
    return std::none_of(near_segments_.begin(), near_segments_.end(),
                        [&](const Ends& s) { return may_meet(around, s.first, s.second); });
  }

  // Whether a segment may meet a box: their boxes meet, and the corners are not all on one side.
  static bool may_meet(const Box& box, Point a, Point b) {
    if (std::max(a.x, b.x) < box.min_x || std::min(a.x, b.x) > box.max_x ||
        std::max(a.y, b.y) < box.min_y || std::min(a.y, b.y) > box.max_y)
      return false;
    const auto is_left = [&](double x, double y) {
      return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x) > 0;
    };
    const int left = is_left(box.min_x, box.min_y) + is_left(box.max_x, box.min_y) +
                     is_left(box.min_x, box.max_y) + is_left(box.max_x, box.max_y);
    return left > 0 && left < 4;
  }

  // Returns whether the rectangle is filled.
  bool fill(const LatticeRectangle& rectangle, double bound) {
    rows_.lay_out(rectangle);
    if (!place_ring(rectangle.spacing, bound)) return false;
    const auto gain = rows_.fill(start_);
    if (!gain) return false;
    refiner_->count(gain->vertices, gain->triangles);
    start_ = *rows_.begin_made();
    if (may_exceed()) queue_large(bound);
    return true;
  }

  // Makes the points of the ring vertices, each found by a walk from the last one. Returns whether
  // that went well.
  bool place_ring(double spacing, double bound) {
    const double clearance2 = kLatticeClearance2 * spacing * spacing;
    for (std::size_t k = 0; k < rows_.ring_size(); ++k) {
      const std::uint32_t vertex = place(rows_.ring_point(k), clearance2, bound);
      if (vertex == kNone) return false;
      rows_.set_ring_vertex(k, vertex);
    }
    return true;
  }

  // Makes a point a vertex, if it is none; kNone if that is not possible.
  std::uint32_t place(Point p, double clearance2, double bound) {
    constexpr int kTries = 8;
    for (int n = 0; n < kTries; ++n) {
      if (start_ == kNone || mesh_.triangles[start_].dead()) start_ = any_current();
      if (start_ == kNone) return kNone;
      const std::uint32_t t = rows_.locate(p, start_);
      if (t == kNone || regions_[mesh_.triangles[t].region].max_area < bound) return kNone;
      const std::uint32_t vertex = rows_.vertex_at(p, t);
      if (vertex != kNone) {
        start_ = t;
        return vertex;
      }
      switch (refiner_->place(t, p, clearance2)) {
        case LeafRefiner::Placing::kPlaced:
          start_ = refiner_->placed();
          return mesh_.triangles[start_].vertex[0];
        case LeafRefiner::Placing::kAgain:
          break;
        case LeafRefiner::Placing::kRefused:
          return kNone;
      }
    }
    return kNone;
  }

  // The first of the bad triangles that still exists; kNone if none does.
  std::uint32_t any_current() const {
    const auto found = std::find_if(bad_->begin(), bad_->end(),
                                    [&](const BadTriangle& b) { return is_current(b); });
    return found != bad_->end() ? found->triangle : kNone;
  }

  // Whether jitter may make a triangle larger than the bound: each corner's adds at most
  // sqrt(2) / 2 jitters to an area of kEquilateral.
  bool may_exceed() const {
    const LatticeShape& lattice = quality_.lattice;
    return lattice.area_ratio * (1 + 5 * lattice.jitter) >= 1;
  }

  void queue_large(double bound) {
    for (const std::uint32_t* t = rows_.begin_made(); t != rows_.end_made(); ++t) {
      Triangle& triangle = mesh_.triangles[*t];
      const Point a = mesh_.vertices[triangle.vertex[0]];
      const Point b = mesh_.vertices[triangle.vertex[1]];
      const Point c = mesh_.vertices[triangle.vertex[2]];
      const double doubled = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
      if (doubled <= 2 * bound) continue;
      triangle.set_badness(badness_of_size(doubled, 2 * bound));
      refiner_->queue(BadTriangle{*t, triangle.vertex[0]});
    }
  }

  MeshStore& mesh_;
  const std::vector<Region>& regions_;
  const QualityBounds quality_;
  const AreaBound& area_;
  HeldBytes::Scope held_;
  LatticeRows rows_;
  LeafRefiner* refiner_ = nullptr;
  const std::vector<BadTriangle>* bad_ = nullptr;
  std::uint32_t start_ = kNone;  // a triangle from which to walk
  std::vector<Ends> near_segments_;
};

}  // namespace weft
