// SPDX-License-Identifier: Apache-2.0
// The star of a vertex that may move: its triangles, its link, and whether another place is as
// good.
//
//   VertexStar<OwnsAll, ConstantArea> star(refinement, quality, ConstantArea(1e-3));
//   star.begin(OwnsAll{}, box, domain.vertices.size(), 0);
//   if (star.may_move(v) && star.find({t, v})) star.move(p);   // t is a triangle of v
//
// What a move keeps:
//   - All bounds: every triangle of the star is good after it.
//   - The constrained Delaunay property: every edge of the star and of its link is still locally
//     Delaunay. So no edge is flipped, and no triangle is written.
//   - Input points and vertices on segments. If there are leaves, the vertices of the owners before
//     the leaves, too, because they are sent before the leaves around.
//   - Ownership (ownership.h): the whole link must be owned. Then no other running task may touch a
//     triangle of the star, and none reads the vertex while it moves.
//
// Units: coordinates of the domain; areas in their square. Errors: bad_size(), as of the bound. Not
// thread-safe: one per task.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/geometry.h"
#include "engine/base/simd.h"
#include "engine/domain/triangulation/predicates.h"
#include "engine/refine/area_bound.h"
#include "engine/refine/cavity.h"
#include "engine/refine/quality_bounds.h"
#include "engine/refine/refinement_context.h"
#include "engine/refine/star_check.h"
#include "engine/refine/storage/mesh_store.h"
#include "engine/size/size_function.h"
#include "weft/error.h"

namespace weft {

template <class Ownership, class AreaBound>
class VertexStar {
 public:
  static constexpr std::uint32_t kMaxEdges = 16;  // of a link; a larger star is not found
  static_assert(kMaxEdges % SizeFunction::kLanes == 0);

  // A vertex, and a triangle of its star.
  struct Corner {
    std::uint32_t triangle;
    std::uint32_t vertex;
  };

  VertexStar(const RefinementContext& refinement, const QualityBounds& quality, AreaBound area)
      : mesh_(refinement.mesh),
        regions_(refinement.regions),
        quality_(quality),
        area_(std::move(area)),
        ring_(kMaxEdges) {}

  // Begins a task in `box`. Vertices below `first_free`, and those of owners below `first_owner`,
  // stay where they are.
  void begin(const Ownership& ownership, const Box& box, std::uint32_t first_free,
             std::uint32_t first_owner) {
    ownership_ = ownership;
    area_.begin(box);
    first_free_ = first_free;
    first_owner_ = first_owner;
  }

  bool may_move(std::uint32_t vertex) const {
    const MeshStore::VertexBlock& block = mesh_.block_of_vertex(vertex);
    return vertex >= first_free_ && !block.on_segment && block.owner >= first_owner_;
  }

  // Finds the star of a vertex. Returns false if the task does not own all of it, or one of its
  // triangles is bad or refused.
  bool find(Corner corner) {
    vertex_ = corner.vertex;
    centre_ = mesh_.vertices[vertex_];
    size_ = 0;
    std::uint32_t t = corner.triangle;
    if (!owns(mesh_.triangles[t])) return false;
    do {
      if (size_ == kMaxEdges) return false;
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
    return true;
  }

  // Of the star that was found last: triangle i, and point i of its link relative to the vertex.
  // Triangle i has the points i and i + 1; the last point is the first one.
  std::uint32_t size() const { return size_; }
  Point centre() const { return centre_; }
  std::uint32_t triangle(std::uint32_t i) const { return triangles_[i]; }
  double x(std::uint32_t i) const { return x_[i]; }
  double y(std::uint32_t i) const { return y_[i]; }
  double region_bound() const { return region_bound_; }

  // The bounds on the areas at the current centroids, one per triangle.
  const double* bounds() {
    for (std::uint32_t i = 0; i < size_; ++i) {
      lanes_.x[i] = centre_.x + (x_[i] + x_[i + 1]) * (1.0 / 3);
      lanes_.y[i] = centre_.y + (y_[i] + y_[i + 1]) * (1.0 / 3);
    }
    area_.bounds_at(size_, lanes_.x, lanes_.y, lanes_.bound);
    for (std::uint32_t i = 0; i < size_; ++i)
      lanes_.bound[i] = std::min(lanes_.bound[i], region_bound_);
    return lanes_.bound;
  }

  // The edge of an equilateral triangle of the star's mean area.
  double mean_edge() const {
    double area = 0;  // doubled
    for (std::uint32_t i = 0; i < size_; ++i) area += x_[i] * y_[i + 1] - y_[i] * x_[i + 1];
    return std::sqrt(1.1547 * area / size_);
  }

  // Moves the vertex to p, if all that a move keeps is kept.
  bool move(Point p) {
    if (!ownership_.may_move(centre_, p)) return false;
    look_from(p);
    return is_good(area_.judge(ring_, 0, size_, p, region_bound_, quality_, judged_.data())) &&
           store_if_delaunay(p);
  }
  // The same, by bounds that are given, twice those on the areas, instead of those at the new
  // centroids.
  bool move(Point p, const double* doubled) {
    if (!ownership_.may_move(centre_, p)) return false;
    look_from(p);
    return is_good(judge_ring(ring_, 0, size_, quality_, DoubledBounds{doubled}, judged_.data())) &&
           store_if_delaunay(p);
  }

  // Whether a vertex at p would lie in the diametral disk of a segment of the link.
  bool encroaches(Point p) const {
    for (std::uint32_t i = 0; i < size_; ++i) {
      if (!ring_.points[i + 1].constrained) continue;
      const double dx = p.x - centre_.x, dy = p.y - centre_.y;
      if ((x_[i] - dx) * (x_[i + 1] - dx) + (y_[i] - dy) * (y_[i + 1] - dy) <= 0) return true;
    }
    return false;
  }

  AreaBound& area() { return area_; }
  const AreaBound& area() const { return area_; }

 private:
  bool owns(const Triangle& t) const {
    return ownership_.owns(mesh_.vertices[t.vertex[0]]) &&
           ownership_.owns(mesh_.vertices[t.vertex[1]]) &&
           ownership_.owns(mesh_.vertices[t.vertex[2]]);
  }

  std::uint32_t corner_of(const Triangle& t) const {
    return t.vertex[0] == vertex_ ? 0 : t.vertex[1] == vertex_ ? 1 : 2;
  }

  // Makes the ring relative to p.
  void look_from(Point p) {
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
  }

  // Whether all triangles of the star meet all bounds.
  bool is_good(const RingVerdict& verdict) const {
    return !verdict.flat && !verdict.too_close &&
           std::all_of(judged_.begin(), judged_.begin() + size_,
                       [](Badness b) { return b == kGood; });
  }

  bool store_if_delaunay(Point p) {
    if (!is_delaunay(p)) return false;
    _mm_storeu_pd(&mesh_.vertices[vertex_].x, _mm_set_pd(p.y, p.x));  // as in slots.h
    return true;
  }

  // Whether the star of p, and the edges of its link, are locally Delaunay. REQUIRES: `is_good`,
  // from there.
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
  const QualityBounds quality_;
  AreaBound area_;
  Ownership ownership_{};
  std::uint32_t first_free_ = 0;
  std::uint32_t first_owner_ = 0;

  // The current star.
  std::uint32_t vertex_ = 0;
  Point centre_;
  std::uint32_t size_ = 0;
  std::array<std::uint32_t, kMaxEdges> triangles_{};
  std::array<double, kMaxEdges + 1> x_{};  // of the link, relative to the centre
  std::array<double, kMaxEdges + 1> y_{};
  struct alignas(64) {
    double x[kMaxEdges];
    double y[kMaxEdges];
    double bound[kMaxEdges];
  } lanes_{};
  double region_bound_ = 0;
  Ring ring_;
  std::array<Badness, kMaxEdges> judged_{};
};

}  // namespace weft
