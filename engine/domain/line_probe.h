// SPDX-License-Identifier: GPL-3.0-or-later
// Looks around a vertex of the triangulation for what lies towards another one.
#pragma once

#include "engine/domain/cdt.h"
#include "engine/domain/predicates.h"

namespace weft {

class LineProbe {
 public:
  enum class Sees {
    kNothingYet,
    kEdge,      // `edge` joins the two vertices
    kVertex,    // `vertex` lies on the line between them
    kCrossing,  // `edge` is the first that the line crosses
  };

  LineProbe(const Cdt& cdt, Cdt::Vertex_handle from, Cdt::Vertex_handle to)
      : cdt_(cdt), from_(from), to_(to), face_(from->face()) {}

  Cdt::Vertex_handle from() const { return from_; }
  Cdt::Vertex_handle to() const { return to_; }
  Cdt::Edge edge() const { return edge_; }
  Cdt::Vertex_handle vertex() const { return vertex_; }

  // Examines one face at `from` and turns to the next, counter-clockwise.
  Sees turn() {
    const Cdt::Face_handle f = face_;
    const int i = f->index(from_);
    face_ = f->neighbor(Cdt::ccw(i));
    if (cdt_.is_infinite(f)) return Sees::kNothingYet;
    const auto [right, left] = ends({f, i});
    if (right == to_ || left == to_) {
      edge_ = {f, right == to_ ? Cdt::cw(i) : Cdt::ccw(i)};
      return Sees::kEdge;
    }
    const int side_right = orientation_exact(at(from_), at(to_), at(right));
    const int side_left = orientation_exact(at(from_), at(to_), at(left));
    if ((side_right == 0 && is_ahead(right)) || (side_left == 0 && is_ahead(left))) {
      vertex_ = side_right == 0 && is_ahead(right) ? right : left;
      return Sees::kVertex;
    }
    if (side_right >= 0 || side_left <= 0) return Sees::kNothingYet;
    edge_ = {f, i};
    return Sees::kCrossing;
  }

 private:
  // For v on the line: whether it is on the side of `to`.
  bool is_ahead(Cdt::Vertex_handle v) const {
    const Point a = at(from_), b = at(to_), p = at(v);
    return a.x != b.x ? (p.x > a.x) == (b.x > a.x) : (p.y > a.y) == (b.y > a.y);
  }

  const Cdt& cdt_;
  Cdt::Vertex_handle from_, to_;
  Cdt::Face_handle face_;
  Cdt::Edge edge_;
  Cdt::Vertex_handle vertex_;
};

}  // namespace weft
