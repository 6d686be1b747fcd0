// SPDX-License-Identifier: GPL-3.0-or-later
// The cavity of a point p: the triangles whose open circumdisk contains p (Bowyer-Watson), and the
// ring of edges around it, in counter-clockwise order.
//
// The cavity grows by a depth-first walk over half-edges, in order: of a triangle that joins, the
// walk takes the edge that comes next around p first. So the ring's edges come out in cyclic order
// and the new triangles link to each other without hashing. With exact predicates the dual of a
// cavity is a tree (no vertex lies inside it), so the walk needs no visited marks.
//
// Shared arithmetic: everything is relative to p. The cross products and squared lengths that the
// walk needs are those of the in-circle filter, and then of the area and angle tests of the new
// triangles (quality_bounds.h).
//
// The in-circle test of d against the ring edge a-b is the sign of
//     |a|^2 (d x b) + |b|^2 (a x d) - |d|^2 (a x b),
// whose rounding error is below 12 u (|a|^2 |b|^2 + (|a|^2 + |b|^2) |d|^2), u = 2^-53: the
// differences are exact to u, a cross product to 4 u |a||d|, a product with a squared length to
// 9 u, the two sums add 2 u, and |a||d| <= (|a|^2 + |d|^2) / 2. Below the bound the exact
// predicate decides: 8 to 140 times in 480,000 insertions. Deciding each with CGAL's filtered
// predicate instead costs 25 % (g++) to 105 % (clang++).
//
// Nothing of the mesh is modified while a cavity grows. With a restricted Ownership a triangle that
// must join but has a vertex that is not owned abandons the insertion (ownership.h).
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/domain/predicates.h"
#include "engine/geometry.h"
#include "engine/refine/mesh.h"
#include "engine/refine/ownership.h"

namespace weft {

inline constexpr double kInCircleError = 12 * 0x1p-53;

// The ring around a cavity, as arrays: edge i goes from point i to point i + 1; coordinates are
// relative to p. A closed ring repeats its first point at the end.
struct Ring {
  explicit Ring(std::size_t capacity)
      : vertex(capacity + 1),
        outside(capacity),
        constrained(capacity),
        x(capacity + 1),
        y(capacity + 1),
        length2(capacity + 1),
        cross(capacity) {}

  std::uint32_t size = 0;             // edges
  std::vector<std::uint32_t> vertex;  // size + 1 entries
  std::vector<HalfEdge> outside;      // across edge i; kNone outside the domain
  std::vector<std::uint8_t> constrained;
  std::vector<double> x, y, length2;  // of point i, size + 1 entries
  std::vector<double> cross;          // point i x point i + 1: twice the area of the new triangle
};

// Edge `edge` of `triangle`, on a segment, with its end points to tell whether it is still there.
struct SegmentEdge {
  std::uint32_t triangle, edge, a, b;
};

template <class Ownership>
class Cavity {
 public:
  enum class Growth {
    kComplete,
    kEncroaches,  // p encroaches upon, or lies behind, the segments in `encroached()`
    kNotOwned,    // the cavity reaches into what the task does not own
    kOverflow,    // out of room: call `enlarge` and try again
  };

  explicit Cavity(const Mesh& mesh)
      : triangles_(mesh.triangles.data()),
        vertices_(mesh.vertices.data()),
        ring_(kInitialCapacity) {
    resize(kInitialCapacity);
  }

  void set_ownership(const Ownership& ownership) { ownership_ = ownership; }

  // The cavity of `p`, which must lie in the circumdisk of `seed`. REQUIRES: the seed's vertices
  // are owned.
  Growth grow_from_triangle(std::uint32_t seed, Point p) {
    const Triangle& t = triangles_[seed];
    const Point a = vertices_[t.vertex[0]];
    cavity_[0] = seed;
    cavity_size_ = 1;
    depth_ = 0;
    push(half_edge(seed, 1), t.vertex[0], a, p);
    push(half_edge(seed, 0), t.vertex[2], vertices_[t.vertex[2]], p);
    push(half_edge(seed, 2), t.vertex[1], vertices_[t.vertex[1]], p);
    return grow(t.vertex[0], p, true);
  }

  // The cavity of a point `p` of the segment that edge `edge` of `triangle` lies on. The ring is
  // closed where the segment has triangles on both sides; `far_end()` is then the ring's index of
  // the segment's other end, and the ring starts at vertex[edge + 2].
  Growth grow_from_segment(std::uint32_t triangle, std::uint32_t edge, Point p) {
    const Triangle& t = triangles_[triangle];
    const std::uint32_t a = t.vertex[kNext[edge]];
    const std::uint32_t b = t.vertex[kPrevious[edge]];
    if (!owns(t.vertex[edge]) || !owns(a) || !owns(b)) return Growth::kNotOwned;
    cavity_[0] = triangle;
    cavity_size_ = 1;
    depth_ = 0;
    const HalfEdge across = t.neighbor[edge];
    if (across != kNone) {
      const std::uint32_t u = triangle_of(across);
      const std::uint32_t j = edge_of(across);
      const std::uint32_t apex = triangles_[u].vertex[j];
      if (!owns(apex)) return Growth::kNotOwned;
      cavity_[cavity_size_++] = u;
      push(half_edge(u, kPrevious[j]), b, vertices_[b], p);
      push(half_edge(u, kNext[j]), apex, vertices_[apex], p);
    }
    push(half_edge(triangle, kPrevious[edge]), a, vertices_[a], p);
    push(half_edge(triangle, kNext[edge]), t.vertex[edge], vertices_[t.vertex[edge]], p);
    const Growth growth = grow(b, p, false);
    far_end_ = 0;
    if (across != kNone && growth == Growth::kComplete) {
      while (ring_.vertex[++far_end_] != a) {
      }
    }
    return growth;
  }

  const Ring& ring() const { return ring_; }
  std::uint32_t far_end() const { return far_end_; }
  const std::vector<SegmentEdge>& encroached() const { return encroached_; }
  const std::uint32_t* triangles() const { return cavity_.data(); }
  std::uint32_t size() const { return cavity_size_; }
  std::uint64_t exact_predicates() const { return exact_predicates_; }

  void enlarge() {
    capacity_ *= 2;
    ring_ = Ring(capacity_);
    resize(capacity_);
  }

  std::uint64_t bytes() const { return capacity_ * (sizeof(Frame) + 2 * 4 + 4 + 1 + 4 * 8); }

 private:
  // A cavity of n triangles has a ring of at most n + 2 edges.
  static constexpr std::size_t kInitialCapacity = 1024;
  static constexpr std::size_t kSlack = 4;

  // A half-edge of the cavity that the walk has yet to cross, with its end point b. Its start is
  // the end of the edge before it.
  struct Frame {
    HalfEdge half_edge;
    std::uint32_t b;
    double bx, by, blength2;
    double cross;  // start x b
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

  void push(HalfEdge h, std::uint32_t b, Point at, Point p) {
    Frame& frame = stack_[depth_++];
    frame.half_edge = h;
    frame.b = b;
    frame.bx = at.x - p.x;
    frame.by = at.y - p.y;
    frame.blength2 = frame.bx * frame.bx + frame.by * frame.by;
  }

  // Walks from the frames on the stack; `first` is where the first edge starts.
  Growth grow(std::uint32_t first, Point p, bool watch_encroachment) {
    const Triangle* const __restrict triangles = triangles_;
    const Point* const __restrict vertices = vertices_;
    Frame* const __restrict stack = stack_.data();
    std::uint32_t* const __restrict cavity = cavity_.data();
    std::uint32_t* const __restrict ring_vertex = ring_.vertex.data();
    HalfEdge* const __restrict ring_outside = ring_.outside.data();
    std::uint8_t* const __restrict ring_constrained = ring_.constrained.data();
    double* const __restrict ring_x = ring_.x.data();
    double* const __restrict ring_y = ring_.y.data();
    double* const __restrict ring_length2 = ring_.length2.data();
    double* const __restrict ring_cross = ring_.cross.data();

    encroached_.clear();
    std::uint32_t depth = depth_;
    std::uint32_t size = cavity_size_;
    std::uint32_t n = 0;
    std::uint32_t a = first;
    double ax = vertices[a].x - p.x;
    double ay = vertices[a].y - p.y;
    double alength2 = ax * ax + ay * ay;
    {
      double x = ax;
      double y = ay;
      for (std::uint32_t i = depth; i-- > 0;) {
        stack[i].cross = x * stack[i].by - y * stack[i].bx;
        x = stack[i].bx;
        y = stack[i].by;
      }
    }
    while (depth > 0) {
      Frame& frame = stack[depth - 1];
      const std::uint32_t t = triangle_of(frame.half_edge);
      const std::uint32_t i = edge_of(frame.half_edge);
      const HalfEdge across = triangles[t].neighbor[i];
      const bool constrained = triangles[t].on_segment(i);
      if (!constrained) [[likely]] {
        const std::uint32_t u = triangle_of(across);
        const std::uint32_t j = edge_of(across);
        const std::uint32_t d = triangles[u].vertex[j];
        const Point at = vertices[d];
        const double dx = at.x - p.x;
        const double dy = at.y - p.y;
        const double dlength2 = dx * dx + dy * dy;
        const double cross_ad = ax * dy - ay * dx;
        const double cross_db = dx * frame.by - dy * frame.bx;
        const double determinant =
            alength2 * cross_db + frame.blength2 * cross_ad - dlength2 * frame.cross;
        const double error =
            kInCircleError * (alength2 * frame.blength2 + (alength2 + frame.blength2) * dlength2);
        bool joins = determinant > error;
        if (std::fabs(determinant) <= error) [[unlikely]] {
          ++exact_predicates_;
          joins = in_circle_exact(vertices[a], at, vertices[frame.b], p);
        }
        if (joins) {
          if (Ownership::kRestricted && !ownership_.owns(at)) [[unlikely]]
            return Growth::kNotOwned;
          if (size + kSlack > capacity_) [[unlikely]]
            return Growth::kOverflow;
          cavity[size++] = u;
          frame.half_edge = half_edge(u, kPrevious[j]);
          frame.cross = cross_db;
          Frame& next = stack[depth++];
          next.half_edge = half_edge(u, kNext[j]);
          next.b = d;
          next.bx = dx;
          next.by = dy;
          next.blength2 = dlength2;
          next.cross = cross_ad;
          continue;
        }
      } else if (watch_encroachment && (ax * frame.bx + ay * frame.by < 0 || frame.cross <= 0)) {
        encroached_.push_back({t, i, a, frame.b});
      }
      ring_vertex[n] = a;
      ring_x[n] = ax;
      ring_y[n] = ay;
      ring_length2[n] = alength2;
      ring_cross[n] = frame.cross;
      ring_outside[n] = across;
      ring_constrained[n] = constrained;
      ++n;
      a = frame.b;
      ax = frame.bx;
      ay = frame.by;
      alength2 = frame.blength2;
      --depth;
    }
    ring_vertex[n] = a;
    ring_x[n] = ax;
    ring_y[n] = ay;
    ring_length2[n] = alength2;
    ring_.size = n;
    cavity_size_ = size;
    return encroached_.empty() ? Growth::kComplete : Growth::kEncroaches;
  }

  const Triangle* triangles_;
  const Point* vertices_;
  Ownership ownership_{};
  std::size_t capacity_ = 0;
  std::vector<Frame> stack_;
  std::vector<std::uint32_t> cavity_;
  std::uint32_t depth_ = 0;
  std::uint32_t cavity_size_ = 0;
  Ring ring_;
  std::uint32_t far_end_ = 0;
  std::vector<SegmentEdge> encroached_;
  std::uint64_t exact_predicates_ = 0;
};

}  // namespace weft
