// SPDX-License-Identifier: Apache-2.0
// The cavity of a point p: the triangles whose open circumdisk contains p (Bowyer-Watson), and the
// ring of edges around it, in counter-clockwise order.
//
// The cavity grows by a depth-first walk over half-edges: from a triangle that joins, the walk
// first takes the edge that comes next around p. So the ring's edges come out in cyclic order,
// and the new triangles are linked to each other without hashing. With exact predicates the dual of
// a cavity is a tree (no vertex lies inside it), so the walk needs no visited marks.
//
// Shared arithmetic: everything is relative to p. The in-circle filter computes the cross products
// and squared lengths; the area and angle tests of the new triangles use them again
// (quality_bounds.h).
//
// When a triangle joins, the triangles across its other two edges are tested at once, each in
// its own lane of SSE registers. That halves the arithmetic, and the walk knows its direction
// in advance.
//
// The in-circle test of d against the ring edge a-b is the sign of
//     |a|^2 (d x b) + |b|^2 (a x d) - |d|^2 (a x b),
// whose rounding error is below 12 u (|a|^2 |b|^2 + (|a|^2 + |b|^2) |d|^2), u = 2^-53: the
// differences are exact to u, a cross product to 4 u |a||d|, a product with a squared length to
// 9 u, the two sums add 2 u, and |a||d| <= (|a|^2 + |d|^2) / 2. Below the bound the exact
// predicate decides: at most a few times in ten thousand insertions.
//
// Growing a cavity does not modify the mesh. With a restricted Ownership the insertion is abandoned
// if a triangle must join but has a vertex that is not owned (ownership.h). Not thread-safe: one
// per task.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/base/geometry.h"
#include "engine/base/simd.h"
#include "engine/domain/triangulation/predicates.h"
#include "engine/refine/lens.h"
#include "engine/refine/ownership.h"
#include "engine/refine/storage/mesh_store.h"

namespace weft {

inline constexpr double kInCircleError = 12 * 0x1p-53;

// A point of the ring around a cavity, and the edge that ends there. The coordinates are relative
// to p.
struct alignas(16) RingPoint {
  double x, y;
  double length2;             // x^2 + y^2
  double cross;               // point before x this one: twice the area of the new triangle
  std::uint32_t vertex;       // of the mesh
  HalfEdge outside;           // across the edge; kNone outside the domain
  std::uint32_t constrained;  // 1 if the edge lies on a segment, 0 elsewhere
};

// Edge i goes from point i to point i + 1. A closed ring repeats its first point at the end. The
// edge of point 0 is not set.
struct Ring {
  explicit Ring(std::size_t capacity) : points(capacity + 1) {}

  std::uint32_t size = 0;         // edges
  std::vector<RingPoint> points;  // size + 1 in use
};

// Edge `edge` of `triangle`, on a segment; its end points tell whether the edge still exists.
struct SegmentEdge {
  std::uint32_t triangle, edge, a, b;
};

template <class Ownership>
class Cavity {
 public:
  enum class Growth {
    kComplete,
    kEncroaches,  // p encroaches upon, or is behind, the segments in `encroached()`
    kNotOwned,    // the cavity reaches triangles that the task does not own
    kOverflow,    // out of room: call `enlarge` and try again
  };

  explicit Cavity(const MeshStore& mesh)
      : triangles_(mesh.triangles.data()),
        vertices_(mesh.vertices.data()),
        owners_(mesh.triangle_owner.data()),
        ring_(kInitialCapacity) {
    resize(kInitialCapacity);
  }

  // Begins a task that owns the slots of `owner`.
  void begin(const Ownership& ownership, std::uint32_t owner) {
    ownership_ = ownership;
    owner_ = owner;
  }

  // Grows the cavity of `p`, which must lie in the circumdisk of `seed` and outside the segments'
  // lenses (lens.h). REQUIRES: the seed's vertices are owned.
  Growth grow_from_triangle(std::uint32_t seed, Point p, double lens) {
    lens_ = lens;
    const Triangle& t = triangles_[seed];
    const __m128d origin = _mm_set_pd(p.y, p.x);
    const End a = end_at(t.vertex[0], origin);
    const End b = end_at(t.vertex[1], origin);
    const End c = end_at(t.vertex[2], origin);
    const double cross_ab = cross(a, b);
    begin_with(seed);
    begin_ring(a);
    Frame* const frames = stack_.data();
    _mm_store_pd(&frames[1].end.x, c.at);
    frames[1].end.vertex = c.vertex;
    test_corner(seed, 0, c, a, b, _mm_set_pd(cross_ab, cross(c, a)), origin, frames[0], frames[1]);
    test_corner(seed, 1, a, b, c, _mm_set_pd(cross(b, c), cross_ab), origin, frames[2], frames[1]);
    const Growth growth = grow(3, origin, true);
    if (growth == Growth::kEncroaches) [[unlikely]]
      keep_what_hides(
          centroid(vertices_[t.vertex[0]], vertices_[t.vertex[1]], vertices_[t.vertex[2]]), p);
    return growth;
  }

  // Grows the cavity of a point `p` of the segment that edge `edge` of `triangle` lies on. The ring
  // is closed if the segment has triangles on both sides; `far_end()` is then the ring's index of
  // the segment's other end, and the ring starts at vertex[edge + 2]. If the segment is an arc, `p`
  // is left of the edge, or beyond it where the domain ends; and the triangle across may stay, as
  // it must if its circumdisk does not hold `p`: then the edge is the last of the ring.
  Growth grow_from_segment(std::uint32_t triangle, std::uint32_t edge, Point p,
                           bool across_stays = false) {
    const Triangle& t = triangles_[triangle];
    if (!owns(t.vertex[0]) || !owns(t.vertex[1]) || !owns(t.vertex[2])) return Growth::kNotOwned;
    const __m128d origin = _mm_set_pd(p.y, p.x);
    const End a = end_at(t.vertex[kNext[edge]], origin);
    const End b = end_at(t.vertex[kPrevious[edge]], origin);
    begin_with(triangle);
    std::uint32_t depth = 0;
    const HalfEdge across = t.neighbor[edge];
    if (across != kNone) {
      const std::uint32_t u = triangle_of(across);
      const std::uint32_t j = edge_of(across);
      if (!owns(triangles_[u].vertex[j])) return Growth::kNotOwned;
      if (!across_stays) {
        cavity_[cavity_size_++] = u;
        foreign_ |= foreign(u);
        begin_side(u, j, a, b, origin, &stack_[depth]);
        depth += 2;
      }
    }
    begin_side(triangle, edge, b, a, origin, &stack_[depth]);
    depth += 2;
    begin_ring(b);
    const Growth growth = grow(depth, origin, false);
    far_end_ = 0;
    if (across == kNone || growth != Growth::kComplete) return growth;
    if (across_stays) {
      far_end_ = ring_.size;
      end_ring(a, b, across);
    } else {
      while (ring_.points[++far_end_].vertex != a.vertex) {
      }
    }
    return growth;
  }

  // The same where the domain ends at the edge, and the point is beyond it: the cavity is empty.
  Growth grow_beyond(std::uint32_t triangle, std::uint32_t edge, Point p) {
    const Triangle& t = triangles_[triangle];
    if (!owns(t.vertex[0]) || !owns(t.vertex[1]) || !owns(t.vertex[2])) return Growth::kNotOwned;
    const __m128d origin = _mm_set_pd(p.y, p.x);
    const End a = end_at(t.vertex[kNext[edge]], origin);
    const End b = end_at(t.vertex[kPrevious[edge]], origin);
    begin_with(triangle);  // whose region the star takes
    cavity_size_ = 0;
    foreign_ = 0;
    begin_ring(b);
    ring_.size = 0;
    end_ring(b, a, half_edge(triangle, edge));
    return Growth::kComplete;
  }

  const Ring& ring() const { return ring_; }
  std::uint32_t far_end() const { return far_end_; }
  const std::vector<SegmentEdge>& encroached() const { return encroached_; }
  // In the order of the walk. There is room for all triangles of the star, and one more.
  std::uint32_t* triangles() { return cavity_.data(); }
  const std::uint32_t* triangles() const { return cavity_.data(); }
  std::uint32_t size() const { return cavity_size_; }
  // Whether all triangles of the cavity lie in slots of the task.
  bool in_own_slots() const { return foreign_ == 0; }
  std::uint64_t exact_predicates() const { return exact_predicates_; }

  void enlarge() {
    capacity_ *= 2;
    ring_ = Ring(capacity_);
    resize(capacity_);
  }

  std::uint64_t bytes() const { return capacity_ * (sizeof(Frame) + sizeof(RingPoint) + 4); }

 private:
  // A cavity of n triangles has a ring of at most n + 2 edges.
  static constexpr std::size_t kInitialCapacity = 1024;
  static constexpr std::size_t kSlack = 4;

  // The value of `constrained` for an edge whose triangle across joins the cavity.
  static constexpr std::uint32_t kJoins = 2;

  // An edge of the cavity that the walk has yet to reach, and the triangle across, already tested.
  // The edge starts where the one before it ends.
  struct Frame {
    RingPoint end;
    double apex_x, apex_y;    // of the triangle across, relative to p
    double cross_with_start;  // start x apex
    double cross_with_end;    // apex x end
    double apex_length2;
    HalfEdge inside;  // the edge itself, if it is constrained
  };

  // An end of an edge, relative to p.
  struct End {
    __m128d at;
    double length2;
    std::uint32_t vertex;
  };

  void resize(std::size_t capacity) {
    capacity_ = capacity;
    stack_.resize(capacity);
    cavity_.resize(capacity);
  }

  bool owns(std::uint32_t vertex) const {
    if constexpr (Ownership::kRestricted) return ownership_.owns(vertices_[vertex]);
    return true;
  }

  // 0 for a triangle in a slot of the task.
  std::uint32_t foreign(std::uint32_t triangle) const {
    if constexpr (Ownership::kRestricted)
      return owners_[triangle >> MeshStore::kTriangleShift] ^ owner_;
    return 0;
  }

  void begin_with(std::uint32_t triangle) {
    cavity_[0] = triangle;
    cavity_size_ = 1;
    foreign_ = foreign(triangle);
  }
  End end_at(std::uint32_t vertex, __m128d origin) const {
    const __m128d at = _mm_sub_pd(_mm_loadu_pd(&vertices_[vertex].x), origin);
    const __m128d squares = _mm_mul_pd(at, at);
    return {at, _mm_cvtsd_f64(_mm_hadd_pd(squares, squares)), vertex};
  }
  static double cross(const End& a, const End& b) {
    const __m128d products = _mm_mul_pd(a.at, _mm_shuffle_pd(b.at, b.at, 1));
    return _mm_cvtsd_f64(_mm_hsub_pd(products, products));
  }

  void begin_ring(const End& first) {
    RingPoint& point = ring_.points[0];
    _mm_store_pd(&point.x, first.at);
    _mm_store_pd(&point.length2, _mm_set_sd(first.length2));
    point.vertex = first.vertex;
  }

  // Adds the edge from `start`, the last point of the ring, to `end`.
  void end_ring(const End& start, const End& end, HalfEdge outside) {
    RingPoint& point = ring_.points[++ring_.size];
    _mm_store_pd(&point.x, end.at);
    point.length2 = end.length2;
    point.cross = cross(start, end);
    point.vertex = end.vertex;
    point.outside = outside;
    point.constrained = 0;
  }

  // The two edges of a triangle beside the segment from `start` to `end`.
  void begin_side(std::uint32_t t, std::uint32_t corner, const End& start, const End& end,
                  __m128d origin, Frame* frames) {
    const End apex = end_at(triangles_[t].vertex[corner], origin);
    _mm_store_pd(&frames[0].end.x, end.at);
    frames[0].end.vertex = end.vertex;
    test_corner(t, corner, start, apex, end, _mm_set_pd(cross(apex, end), cross(start, apex)),
                origin, frames[1], frames[0]);
  }

  // Tests the triangles across the two edges at a corner of triangle t: from `start` to the corner
  // (`first`), and from the corner to `end` (`second`, which knows its end).
  [[gnu::always_inline]] void test_corner(std::uint32_t t, std::uint32_t corner, const End& start,
                                          const End& at, const End& end, __m128d cross_ab,
                                          __m128d origin, Frame& first, Frame& second) {
    const Triangle* const __restrict triangles = triangles_;
    const Point* const __restrict vertices = vertices_;
    const Triangle& triangle = triangles[t];
    HalfEdge first_across = triangle.neighbor[kNext[corner]];
    HalfEdge second_across = triangle.neighbor[kPrevious[corner]];
    first.end.outside = first_across;
    second.end.outside = second_across;
    const std::uint32_t segments = triangle.segment_bits();
    if (segments != 0) [[unlikely]] {
      // The triangle across a segment is not used, so its own corner is a valid substitute.
      if (triangle.on_segment(kNext[corner])) first_across = half_edge(t, corner);
      if (triangle.on_segment(kPrevious[corner])) second_across = half_edge(t, corner);
    }
    const std::uint32_t first_vertex =
        triangles[triangle_of(first_across)].vertex[edge_of(first_across)];
    const std::uint32_t second_vertex =
        triangles[triangle_of(second_across)].vertex[edge_of(second_across)];
    const __m128d first_apex = _mm_sub_pd(_mm_loadu_pd(&vertices[first_vertex].x), origin);
    const __m128d second_apex = _mm_sub_pd(_mm_loadu_pd(&vertices[second_vertex].x), origin);

    // One lane per edge: a is its start, b its end, d the apex across.
    const __m128d ax = _mm_unpacklo_pd(start.at, at.at);
    const __m128d ay = _mm_unpackhi_pd(start.at, at.at);
    const __m128d bx = _mm_unpacklo_pd(at.at, end.at);
    const __m128d by = _mm_unpackhi_pd(at.at, end.at);
    const __m128d dx = _mm_unpacklo_pd(first_apex, second_apex);
    const __m128d dy = _mm_unpackhi_pd(first_apex, second_apex);
    const __m128d alength2 = _mm_set_pd(at.length2, start.length2);
    const __m128d blength2 = _mm_set_pd(end.length2, at.length2);
    const __m128d dlength2 = _mm_add_pd(_mm_mul_pd(dx, dx), _mm_mul_pd(dy, dy));
    const __m128d cross_ad = _mm_sub_pd(_mm_mul_pd(ax, dy), _mm_mul_pd(ay, dx));
    const __m128d cross_db = _mm_sub_pd(_mm_mul_pd(dx, by), _mm_mul_pd(dy, bx));
    const __m128d determinant =
        _mm_sub_pd(_mm_add_pd(_mm_mul_pd(alength2, cross_db), _mm_mul_pd(blength2, cross_ad)),
                   _mm_mul_pd(dlength2, cross_ab));
    const __m128d error =
        _mm_mul_pd(_mm_set1_pd(kInCircleError),
                   _mm_add_pd(_mm_mul_pd(alength2, blength2),
                              _mm_mul_pd(_mm_add_pd(alength2, blength2), dlength2)));
    auto joins = static_cast<std::uint32_t>(_mm_movemask_pd(_mm_cmpgt_pd(determinant, error)));
    const __m128d magnitude = _mm_andnot_pd(_mm_set1_pd(-0.0), determinant);
    const int unsure = _mm_movemask_pd(_mm_cmple_pd(magnitude, error));
    if (unsure != 0) [[unlikely]] {
      if ((unsure & 1) != 0 && first_across == first.end.outside)
        joins |= in_circle(start.vertex, first_vertex, at.vertex, origin);
      if ((unsure & 2) != 0 && second_across == second.end.outside)
        joins |= in_circle(at.vertex, second_vertex, end.vertex, origin) << 1;
    }
    _mm_store_pd(&first.end.x, at.at);
    first.end.vertex = at.vertex;
    _mm_store_pd(&first.end.length2, _mm_unpacklo_pd(blength2, cross_ab));
    _mm_store_pd(&second.end.length2, _mm_unpackhi_pd(blength2, cross_ab));
    first.end.constrained = joins << 1 & kJoins;
    second.end.constrained = joins & kJoins;
    if (segments != 0) [[unlikely]] {
      if (triangle.on_segment(kNext[corner])) first.end.constrained = 1;
      if (triangle.on_segment(kPrevious[corner])) second.end.constrained = 1;
      first.inside = half_edge(t, kNext[corner]);
      second.inside = half_edge(t, kPrevious[corner]);
    }
    _mm_store_pd(&first.apex_x, first_apex);
    _mm_store_pd(&second.apex_x, second_apex);
    _mm_store_pd(&first.cross_with_start, _mm_unpacklo_pd(cross_ad, cross_db));
    _mm_store_pd(&second.cross_with_start, _mm_unpackhi_pd(cross_ad, cross_db));
    _mm_storel_pd(&first.apex_length2, dlength2);
    _mm_storeh_pd(&second.apex_length2, dlength2);
  }

  // 1 or 0.
  [[gnu::noinline, gnu::cold]] std::uint32_t in_circle(std::uint32_t a, std::uint32_t b,
                                                       std::uint32_t c, __m128d origin) {
    ++exact_predicates_;
    Point p;
    _mm_storeu_pd(&p.x, origin);
    return in_circle_exact(vertices_[a], vertices_[b], vertices_[c], p) ? 1 : 0;
  }

  // Records the segment that a constrained edge lies on, if p encroaches upon it.
  [[gnu::noinline, gnu::cold]] void watch(const RingPoint& start, const Frame& edge) {
    const RingPoint& end = edge.end;
    if (end.cross <= 0 || in_lens(start.x, start.y, end.x, end.y, lens_)) {
      encroached_.push_back(
          {triangle_of(edge.inside), edge_of(edge.inside), start.vertex, end.vertex});
    }
  }

  // If segments hide p from a point of the seed, keeps only the nearest of these as encroached
  // upon.
  [[gnu::noinline, gnu::cold]] void keep_what_hides(Point from, Point p) {
    const auto side = [](Point a, Point b, Point c) {
      return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    };
    if (encroached_.size() < 2) return;
    double nearest = 1;  // fraction of the way
    for (const SegmentEdge s : std::vector<SegmentEdge>(encroached_)) {
      const Point a = vertices_[s.a];
      const Point b = vertices_[s.b];
      const double before = side(a, b, from);
      const double fraction = before / (before - side(a, b, p));
      const bool between = (side(from, p, a) < 0) != (side(from, p, b) < 0);
      if (!(between && fraction > 0 && fraction < nearest)) continue;
      nearest = fraction;
      encroached_.assign(1, s);
    }
  }

  // Copies field by field, as they were written a moment ago: a processor forwards a store to a
  // load that it covers, but not two stores to one load.
  static void copy(const RingPoint& from, RingPoint& to) {
    _mm_store_pd(&to.x, _mm_load_pd(&from.x));
    _mm_store_pd(&to.length2, _mm_load_pd(&from.length2));
    to.vertex = from.vertex;
    to.outside = from.outside;
    to.constrained = from.constrained;
  }

  // Walks from `depth` frames on the stack.
  Growth grow(std::uint32_t depth, __m128d origin, bool watch_encroachment) {
    const Triangle* const __restrict triangles = triangles_;
    Frame* const bottom = stack_.data();
    Frame* above = bottom + depth;
    RingPoint* last = ring_.points.data();
    std::uint32_t* const cavity = cavity_.data();
    encroached_.clear();
    std::uint32_t size = cavity_size_;
    std::uint32_t foreign_slots = foreign_;
    do {
      Frame& frame = above[-1];
      if (frame.end.constrained != kJoins) {
        if (frame.end.constrained != 0 && watch_encroachment) [[unlikely]]
          watch(*last, frame);
        copy(frame.end, *++last);
        --above;
        continue;
      }
      const std::uint32_t u = triangle_of(frame.end.outside);
      const std::uint32_t j = edge_of(frame.end.outside);
      const std::uint32_t d = triangles[u].vertex[j];
      if (Ownership::kRestricted && !ownership_.owns(vertices_[d])) [[unlikely]]
        return Growth::kNotOwned;
      if (size + kSlack > capacity_) [[unlikely]]
        return Growth::kOverflow;
      cavity[size++] = u;
      foreign_slots |= foreign(u);
      const End a{_mm_load_pd(&last->x), last->length2, last->vertex};
      const End apex{_mm_load_pd(&frame.apex_x), frame.apex_length2, d};
      const End b{_mm_load_pd(&frame.end.x), frame.end.length2, frame.end.vertex};
      test_corner(u, j, a, apex, b, _mm_load_pd(&frame.cross_with_start), origin, *above, frame);
      ++above;
    } while (above != bottom);
    ring_.size = static_cast<std::uint32_t>(last - ring_.points.data());
    cavity_size_ = size;
    foreign_ = foreign_slots;
    return encroached_.empty() ? Growth::kComplete : Growth::kEncroaches;
  }

  const Triangle* triangles_;
  const Point* vertices_;
  const std::uint32_t* owners_;  // of the slots
  Ownership ownership_{};
  std::uint32_t owner_ = 0;
  std::size_t capacity_ = 0;
  std::vector<Frame> stack_;
  std::vector<std::uint32_t> cavity_;
  std::uint32_t cavity_size_ = 0;
  std::uint32_t foreign_ = 0;  // not 0 if the cavity has slots of other owners
  Ring ring_;
  std::uint32_t far_end_ = 0;
  double lens_ = kDiametralDisk;
  std::vector<SegmentEdge> encroached_;
  std::uint64_t exact_predicates_ = 0;
};

}  // namespace weft
