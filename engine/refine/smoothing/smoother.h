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
// What is kept:
//   - All bounds: a move is made only if every triangle of the star is good after it.
//   - The constrained Delaunay property: only if every edge of the star and of its link is still
//     locally Delaunay. So no edge is flipped, and no triangle is written.
//   - Input points and vertices on segments do not move. If there are leaves, the vertices of the
//     owners before the leaves do not move either, because they are sent before the leaves around.
//   - Ownership (ownership.h): the whole link must be owned. Then no other running task may touch a
//     triangle of the star, and none reads the vertex while it moves.
// A sweep visits the stars in the order of the slots, so the mesh depends only on the request.
//
// Two sweeps raise the 1st percentile of the smallest angles by 2 to 5 degrees, for about 12 % more
// instructions (bench/README.md).
//
// Errors: those of refinement (refine/refiner.h). Not thread-safe: one per task.
#pragma once

#include <emmintrin.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/context.h"
#include "engine/base/geometry.h"
#include "engine/domain/triangulation/predicates.h"
#include "engine/refine/area_bound.h"
#include "engine/refine/cavity.h"
#include "engine/refine/quality_bounds.h"
#include "engine/refine/refinement_context.h"
#include "engine/refine/smoothing/star_search.h"
#include "engine/refine/star_check.h"
#include "engine/refine/storage/mesh_store.h"
#include "engine/refine/storage/slots.h"
#include "engine/refine/storage/vertex_set.h"
#include "engine/size/size_function.h"
#include "weft/error.h"

namespace weft {

template <class Ownership, class AreaBound>
class Smoother {
 public:
  Smoother(const RefinementContext& refinement, const QualityBounds& quality, AreaBound area)
      : mesh_(refinement.mesh),
        regions_(refinement.regions),
        context_(refinement.context),
        quality_(quality),
        area_(std::move(area)),
        ring_(kMostEdges) {}

  // Begins a task in `box`. Vertices below `first_free`, and those of owners below `first_owner`,
  // stay where they are.
  void begin(const Ownership& ownership, const Box& box, std::uint32_t first_free,
             std::uint32_t first_owner) {
    ownership_ = ownership;
    area_.begin(box);
    first_free_ = first_free;
    first_owner_ = first_owner;
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
  // A vertex, and a triangle of its star.
  struct Corner {
    std::uint32_t triangle;
    std::uint32_t vertex;
  };

  static constexpr std::uint32_t kMostEdges = StarSearch::kMostEdges;
  static_assert(kMostEdges % SizeFunction::kLanes == 0);
  static constexpr double kPoor = StarSearch::kGoodEnough;
  static constexpr float kLeastGain = 1.01F;
  static constexpr std::size_t kPollInterval = 256;  // stars

  std::optional<Error> poll() const {
    if (const auto& bad = area_.bad_size()) return bad_size_error(*bad);
    return context_.poll();
  }

  bool may_move(std::uint32_t vertex) const {
    const MeshStore::VertexBlock& block = mesh_.block_of_vertex(vertex);
    return vertex >= first_free_ && !block.on_segment && block.owner >= first_owner_;
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
      if (may_move(vertex) && seen_.add(vertex)) next_.push_back({t, vertex});
    }
  }

  // Moves a vertex if that gains anything. `again`: keep triangles that stay poor for the next
  // sweep.
  void smooth(Corner corner, bool again) {
    if (!find_star(corner)) return;
    const StarSearch::Place best = star_.search();
    if (best.gain > kLeastGain) move({centre_.x + best.x, centre_.y + best.y});
    for (std::uint32_t i = 0; again && i < size_; ++i) {
      if (poor(mesh_.triangles[triangles_[i]])) queue_corners(triangles_[i]);
    }
  }

  // Finds the star of a vertex, relative to it. Returns false if the task does not own all of it,
  // or one of its triangles is refused.
  bool find_star(Corner corner) {
    vertex_ = corner.vertex;
    centre_ = mesh_.vertices[vertex_];
    size_ = 0;
    std::uint32_t t = corner.triangle;
    if (!owns(mesh_.triangles[t])) return false;
    do {
      if (size_ == kMostEdges) return false;
      const Triangle& triangle = mesh_.triangles[t];
      const std::uint32_t k = corner_of(triangle);
      const Point start = mesh_.vertices[triangle.vertex[kNext[k]]];
      RingPoint& end = ring_.points[size_ + 1];  // of this triangle's edge of the link
      end.vertex = triangle.vertex[kPrevious[k]];
      if (!ownership_.owns(mesh_.vertices[end.vertex]) || triangle.badness() != kGood ||
          triangle.refusal() != Refusal::kNone) {
        return false;
      }
      triangles_[size_] = t;
      end.outside = triangle.neighbor[k];
      end.constrained = triangle.on_segment(k);
      x_[size_] = start.x - centre_.x;
      y_[size_] = start.y - centre_.y;
      ++size_;
      t = triangle_of(triangle.neighbor[kNext[k]]);
    } while (t != corner.triangle);
    ring_.size = size_;
    ring_.points[0].vertex = ring_.points[size_].vertex;
    x_[size_] = x_[0];
    y_[size_] = y_[0];
    region_bound_ = regions_[mesh_.triangles[t].region].max_area;
    begin_search();
    return true;
  }

  bool owns(const Triangle& t) const {
    return ownership_.owns(mesh_.vertices[t.vertex[0]]) &&
           ownership_.owns(mesh_.vertices[t.vertex[1]]) &&
           ownership_.owns(mesh_.vertices[t.vertex[2]]);
  }

  std::uint32_t corner_of(const Triangle& t) const {
    return t.vertex[0] == vertex_ ? 0 : t.vertex[1] == vertex_ ? 1 : 2;
  }

  // Begins the search, with the bounds on the areas at the current centroids.
  void begin_search() {
    double area = 0;  // doubled
    for (std::uint32_t i = 0; i < size_; ++i) {
      lanes_.x[i] = centre_.x + (x_[i] + x_[i + 1]) * (1.0 / 3);
      lanes_.y[i] = centre_.y + (y_[i] + y_[i + 1]) * (1.0 / 3);
      area += x_[i] * y_[i + 1] - y_[i] * x_[i + 1];
    }
    area_.bounds_at(size_, lanes_.x, lanes_.y, lanes_.bound);
    // The edge of an equilateral triangle of the star's mean area.
    star_.begin(size_, std::sqrt(1.1547 * area / size_));
    for (std::uint32_t i = 0; i <= size_; ++i) star_.set_point(i, x_[i], y_[i]);
    for (std::uint32_t i = 0; i < size_; ++i)
      star_.set_bound(i, std::min(lanes_.bound[i], region_bound_));
  }

  void move(Point p) {
    if (!ownership_.may_move(centre_, p) || !is_good(p) || !is_delaunay(p)) return;
    _mm_storeu_pd(&mesh_.vertices[vertex_].x, _mm_set_pd(p.y, p.x));  // as in slots.h
  }

  // Whether all triangles of the star meet all bounds if the vertex is at p. Leaves the ring
  // relative to p.
  bool is_good(Point p) {
    for (std::uint32_t i = 0; i <= size_; ++i) {
      RingPoint& point = ring_.points[i];
      const Point at = mesh_.vertices[point.vertex];
      point.x = at.x - p.x;
      point.y = at.y - p.y;
      point.length2 = point.x * point.x + point.y * point.y;
      if (i == 0) continue;
      const RingPoint& before = ring_.points[i - 1];
      point.cross = before.x * point.y - before.y * point.x;
    }
    const RingVerdict verdict =
        area_.judge(ring_, 0, size_, p, region_bound_, quality_, judged_.data());
    return !verdict.flat && !verdict.too_close &&
           std::all_of(judged_.begin(), judged_.begin() + size_,
                       [](Badness b) { return b == kGood; });
  }

  // Whether the star of p, and the edges of its link, are locally Delaunay. REQUIRES: `is_good`.
  bool is_delaunay(Point p) {
    for (std::uint32_t i = 1; i <= size_; ++i) {
      const RingPoint& a = ring_.points[i - 1];
      const RingPoint& b = ring_.points[i];
      if (b.constrained || b.outside == kNone) continue;
      const Triangle& across = mesh_.triangles[triangle_of(b.outside)];
      const Point d = mesh_.vertices[across.vertex[edge_of(b.outside)]];
      const double dx = d.x - p.x;
      const double dy = d.y - p.y;
      const double d2 = dx * dx + dy * dy;
      const double inside =
          a.length2 * (dx * b.y - dy * b.x) + b.length2 * (a.x * dy - a.y * dx) - d2 * b.cross;
      const double error = kInCircleError * (a.length2 * b.length2 + (a.length2 + b.length2) * d2);
      if (inside > error) return false;
      if (inside >= -error &&
          in_circle_exact(p, mesh_.vertices[a.vertex], mesh_.vertices[b.vertex], d)) {
        return false;
      }
    }
    if (!star_is_delaunay(mesh_, ring_, 0, size_, p)) return false;
    // Rotates the ring, to test the edge at which it is closed.
    std::rotate(ring_.points.begin() + 1, ring_.points.begin() + 2,
                ring_.points.begin() + size_ + 1);
    ring_.points[0] = ring_.points[size_];
    return star_is_delaunay(mesh_, ring_, size_ - 2, size_, p);
  }

  MeshStore& mesh_;
  const std::vector<Region>& regions_;
  ExecutionContext& context_;
  const QualityBounds quality_;
  AreaBound area_;
  Ownership ownership_{};
  std::uint32_t first_free_ = 0;
  std::uint32_t first_owner_ = 0;

  std::vector<Corner> now_;   // of this sweep
  std::vector<Corner> next_;  // and of the next, whose vertices are in `seen_`
  VertexSet seen_;

  // The current star: triangle i has the edge of the link from point i to i + 1.
  std::uint32_t vertex_ = 0;
  Point centre_;
  std::uint32_t size_ = 0;
  std::array<std::uint32_t, kMostEdges> triangles_{};
  std::array<double, kMostEdges + 1> x_{};  // of the link, relative to the centre
  std::array<double, kMostEdges + 1> y_{};
  struct alignas(64) {
    double x[kMostEdges];
    double y[kMostEdges];
    double bound[kMostEdges];  // doubled, as areas are
  } lanes_{};
  double region_bound_ = 0;
  StarSearch star_;
  Ring ring_;
  std::array<Badness, kMostEdges> judged_{};
};

}  // namespace weft
