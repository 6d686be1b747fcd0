// SPDX-License-Identifier: Apache-2.0
// The cavity of a point p that becomes a vertex of a Delaunay triangulation: the faces in conflict
// with p (face.h), and the edges around them. Only for cavities that are small and off the hull, as
// nearly all are.
//
//   SmallCavity cavity;
//   if (cavity.find(faces, points, p, first)) ... cavity.faces(), cavity.border()
//
// The faces come in the order of a depth-first walk, the edges counter-clockwise: as in
// Triangulation::find_cavity, which is the general way, so both number new faces alike.
//
// Shared arithmetic: everything is relative to p. For a face in conflict, the faces across
// its other two edges are tested at once, each in its own lane of SSE registers, and terms that
// later tests share are kept (refine/cavity.h does the same, and derives
// the filter's error bound). If the filter cannot decide, `conflicts` does, so all decisions
// are exact. The bound assumes that nothing underflows; what underflow adds is below 1e-200, as in
// filtered.h. This triangulates a coast of 9,370 points in 3.0 ms; one test after the other takes
// 3.8 ms.
#pragma once

#include <algorithm>
#include <cstdint>

#include "engine/base/geometry.h"
#include "engine/base/simd.h"
#include "engine/domain/face.h"

namespace weft {

class SmallCavity {
 public:
  static constexpr std::uint32_t kMaxFaces = 60;

  // Returns false if the cavity has more than kMaxFaces faces or an infinite one: then its faces
  // and border are not valid.
  // REQUIRES: face `first` is in conflict with p, and p is not at a vertex.
  bool find(const Face* faces, const Point* points, Point p, std::uint32_t first) {
    faces_ = faces;
    points_ = points;
    p_ = p;
    origin_ = _mm_set_pd(p.y, p.x);
    is_at_hull_ = false;
    const Face& face = faces[first];
    if (face.vertex[0] == kNone || face.vertex[1] == kNone || face.vertex[2] == kNone) [[unlikely]]
      return false;
    const End a = end_at(face.vertex[0]);
    const End b = end_at(face.vertex[1]);
    const End c = end_at(face.vertex[2]);
    const double cross_bc = cross(b, c);
    // The edges in the order of the walk: b-c, c-a, a-b.
    test_corner(first, 1, a, b, c, _mm_set_pd(cross_bc, cross(a, b)), frames_[0], frames_[1]);
    store_end(a, frames_[1]);
    test_corner(first, 2, b, c, a, _mm_set_pd(cross(c, a), cross_bc), frames_[2], frames_[1]);
    cavity_[0] = first;
    return walk(b);
  }

  // The faces in conflict, `first` first; there is room for three more.
  std::uint32_t* faces() { return cavity_; }
  std::uint32_t size() const { return size_; }
  // size() + 2 edges, then the first once more.
  const Border* border() const { return border_; }
  // The square of the distance from p to the nearest vertex of the border.
  double nearest2() const { return nearest2_; }

 private:
  // An edge of the cavity that the walk has yet to reach, and the face across, already tested. The
  // edge starts where the one before it ends.
  struct alignas(16) Frame {
    double x, y;              // of the end, relative to p
    double length2;           // x^2 + y^2
    double cross;             // start x end
    double apex_x, apex_y;    // of the face across
    double cross_with_start;  // start x apex
    double cross_with_end;    // apex x end
    double apex_length2;
    std::uint32_t vertex;   // the end
    std::uint32_t outside;  // half-edge
    std::uint32_t joins;    // whether the face across is in conflict
  };

  // An end of an edge, relative to p.
  struct End {
    __m128d at;
    double length2;
    std::uint32_t vertex;
  };

  End end_at(std::uint32_t vertex) const {
    const __m128d at = _mm_sub_pd(_mm_loadu_pd(&points_[vertex].x), origin_);
    const __m128d squares = _mm_mul_pd(at, at);
    return {at, _mm_cvtsd_f64(_mm_hadd_pd(squares, squares)), vertex};
  }
  static double cross(const End& a, const End& b) {
    const __m128d products = _mm_mul_pd(a.at, _mm_shuffle_pd(b.at, b.at, 1));
    return _mm_cvtsd_f64(_mm_hsub_pd(products, products));
  }
  static void store_end(const End& end, Frame& frame) {
    _mm_store_pd(&frame.x, end.at);
    frame.vertex = end.vertex;
  }

  // Tests the faces across the two edges at a corner of face f: from `start` to the corner
  // (`first`), and from the corner to `end` (`second`, which knows its end). The lanes of cross_ab
  // are the cross products of the two edges' ends.
  [[gnu::always_inline]] void test_corner(std::uint32_t f, int corner, const End& start,
                                          const End& at, const End& end, __m128d cross_ab,
                                          Frame& first, Frame& second) {
    constexpr double kError = 12 * 0x1p-53;
    constexpr double kUnderflow = 1e-200;
    const Face& face = faces_[f];
    first.outside = face.neighbor[ccw(corner)];
    second.outside = face.neighbor[cw(corner)];
    std::uint32_t first_vertex = faces_[first.outside >> 2].vertex[first.outside & 3];
    std::uint32_t second_vertex = faces_[second.outside >> 2].vertex[second.outside & 3];
    const bool is_infinite = (first_vertex == kNone) | (second_vertex == kNone);
    if (is_infinite) [[unlikely]] {
      // No face in conflict has an infinite vertex, so the substitute is not looked at again.
      if (first_vertex == kNone) first_vertex = at.vertex;
      if (second_vertex == kNone) second_vertex = at.vertex;
    }
    const __m128d first_apex = _mm_sub_pd(_mm_loadu_pd(&points_[first_vertex].x), origin_);
    const __m128d second_apex = _mm_sub_pd(_mm_loadu_pd(&points_[second_vertex].x), origin_);

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
    const __m128d permanent = _mm_add_pd(_mm_mul_pd(alength2, blength2),
                                         _mm_mul_pd(_mm_add_pd(alength2, blength2), dlength2));
    const __m128d error =
        _mm_add_pd(_mm_mul_pd(_mm_set1_pd(kError), permanent), _mm_set1_pd(kUnderflow));
    auto joins = static_cast<std::uint32_t>(_mm_movemask_pd(_mm_cmpgt_pd(determinant, error)));
    const __m128d magnitude = _mm_andnot_pd(_mm_set1_pd(-0.0), determinant);
    const int unsure = _mm_movemask_pd(_mm_cmple_pd(magnitude, error));
    if ((unsure != 0) | is_infinite) [[unlikely]]
      joins = decide(first.outside, second.outside);
    _mm_store_pd(&first.x, at.at);
    first.vertex = at.vertex;
    _mm_store_pd(&first.length2, _mm_unpacklo_pd(blength2, cross_ab));
    _mm_store_pd(&second.length2, _mm_unpackhi_pd(blength2, cross_ab));
    first.joins = joins & 1;
    second.joins = joins >> 1;
    _mm_store_pd(&first.apex_x, first_apex);
    _mm_store_pd(&second.apex_x, second_apex);
    _mm_store_pd(&first.cross_with_start, _mm_unpacklo_pd(cross_ad, cross_db));
    _mm_store_pd(&second.cross_with_start, _mm_unpackhi_pd(cross_ad, cross_db));
    _mm_storel_pd(&first.apex_length2, dlength2);
    _mm_storeh_pd(&second.apex_length2, dlength2);
  }

  // Exactly: 1 if the first of the two faces is in conflict, and 2 if the second is.
  [[gnu::noinline, gnu::cold]] std::uint32_t decide(std::uint32_t first, std::uint32_t second) {
    std::uint32_t joins = 0;
    for (const std::uint32_t h : {second, first}) {
      const Face& face = faces_[h >> 2];
      const bool is_in_conflict = conflicts(face, points_, p_);
      const bool is_infinite =
          face.vertex[0] == kNone || face.vertex[1] == kNone || face.vertex[2] == kNone;
      is_at_hull_ |= is_infinite && is_in_conflict;
      joins = joins << 1 | (is_in_conflict ? 1 : 0);
    }
    return joins;
  }

  // From the first face, whose three edges are on the stack; the top one starts at `from`.
  bool walk(End from) {
    std::uint32_t size = 1;
    double nearest2 = from.length2;
    Border* last = border_;
    Frame* above = frames_ + 3;
    do {
      Frame& frame = above[-1];
      if (!frame.joins) {
        *last++ = {from.vertex, frame.outside};
        nearest2 = std::min(nearest2, from.length2);
        from = {_mm_load_pd(&frame.x), frame.length2, frame.vertex};
        --above;
        continue;
      }
      if (size == kMaxFaces || is_at_hull_) [[unlikely]]
        return false;
      const std::uint32_t f = frame.outside >> 2;
      const int i = static_cast<int>(frame.outside & 3);
      cavity_[size++] = f;
      const End apex{_mm_load_pd(&frame.apex_x), frame.apex_length2, faces_[f].vertex[i]};
      const End end{_mm_load_pd(&frame.x), frame.length2, frame.vertex};
      test_corner(f, i, from, apex, end, _mm_load_pd(&frame.cross_with_start), *above, frame);
      ++above;
    } while (above != frames_);
    *last = border_[0];
    size_ = size;
    nearest2_ = nearest2;
    return true;
  }

  const Face* faces_ = nullptr;
  const Point* points_ = nullptr;
  Point p_;
  __m128d origin_{};
  bool is_at_hull_ = false;
  std::uint32_t size_ = 0;
  double nearest2_ = 0;
  Frame frames_[kMaxFaces + 2];
  std::uint32_t cavity_[kMaxFaces + 3];
  Border border_[kMaxFaces + 3];
};

}  // namespace weft
