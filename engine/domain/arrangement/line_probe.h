// SPDX-License-Identifier: Apache-2.0
// Finds what the line from a vertex of the triangulation to another one meets first.
#pragma once

#include "engine/domain/triangulation/triangulation.h"

namespace weft {

class LineProbe {
  using Vertex = Triangulation::Vertex;
  using Edge = Triangulation::Edge;

 public:
  enum class Sees {
    kNothingYet,
    kEdge,      // `edge` joins the two vertices
    kVertex,    // `vertex` lies on the line between them
    kCrossing,  // `edge` is the first that the line crosses
  };

  LineProbe(const Triangulation& triangulation, Vertex from, Vertex to)
      : t_(triangulation), from_(from), to_(to), face_(triangulation.face_at(from)) {}

  Vertex from() const { return from_; }
  Vertex to() const { return to_; }
  Edge edge() const { return edge_; }
  Vertex vertex() const { return vertex_; }

  // Examines one face at `from` and turns to the next, counter-clockwise.
  Sees turn() {
    const std::uint32_t f = face_;
    const int i = t_.index(f, from_);
    face_ = t_.mirror({f, Triangulation::ccw(i)}).face;
    if (t_.is_infinite(f)) return Sees::kNothingYet;
    const Edge opposite{f, i};
    const Vertex right = t_.right(opposite), left = t_.left(opposite);
    if (right == to_ || left == to_) {
      edge_ = {f, right == to_ ? Triangulation::cw(i) : Triangulation::ccw(i)};
      return Sees::kEdge;
    }
    const int side_right = orientation(t_.at(from_), t_.at(to_), t_.at(right));
    const int side_left = orientation(t_.at(from_), t_.at(to_), t_.at(left));
    if ((side_right == 0 && is_ahead(right)) || (side_left == 0 && is_ahead(left))) {
      vertex_ = side_right == 0 && is_ahead(right) ? right : left;
      return Sees::kVertex;
    }
    if (side_right >= 0 || side_left <= 0) return Sees::kNothingYet;
    edge_ = opposite;
    return Sees::kCrossing;
  }

 private:
  // For v on the line: whether it is on the side of `to`.
  bool is_ahead(Vertex v) const {
    const Point a = t_.at(from_), b = t_.at(to_), p = t_.at(v);
    return a.x != b.x ? (p.x > a.x) == (b.x > a.x) : (p.y > a.y) == (b.y > a.y);
  }

  const Triangulation& t_;
  Vertex from_, to_;
  std::uint32_t face_;
  Edge edge_;
  Vertex vertex_;
};

}  // namespace weft
