// SPDX-License-Identifier: GPL-3.0-or-later
// Leads the segments of a PSLG through the triangulation of its points, each as a chain of
// constrained edges. See arrangement.h for how segments meet.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "engine/domain/arrangement.h"
#include "engine/domain/line_probe.h"
#include "engine/domain/pacer.h"
#include "engine/domain/pslg.h"
#include "engine/domain/triangulation.h"

namespace weft {

class SegmentInserter {
 public:
  // `triangulation` is that of the points. All references must outlive the inserter.
  SegmentInserter(const Pslg& pslg, Triangulation& triangulation, std::uint64_t max_splits,
                  Pacer& pacer);

  // Throws Stopped.
  void insert_all();

  // By the numbers that the triangulation has; some are no longer in use.
  std::vector<Arrangement::Constraint> take_constraints() { return std::move(constraints_); }
  std::uint32_t crossings() const { return crossings_; }  // vertices made where segments cross

 private:
  using Constraint = Arrangement::Constraint;
  using Vertex = Triangulation::Vertex;
  using Edge = Triangulation::Edge;

  // A part of one or more input segments that is to become an edge, or several.
  struct Piece {
    Vertex u, v;
    Constraint constraint;
  };

  void insert(const Piece& piece);
  void walk(const LineProbe& probe, const Piece& piece);
  void cross(Edge edge, const Piece& piece);
  bool meet_at(Point p, double snap, Edge edge, const Piece& piece);
  void meet_in_end(Vertex w, Edge edge, const Piece& piece);
  void meet_in_new_vertex(Point p, Edge edge, const Piece& piece);

  void push(Vertex u, Vertex v, const Constraint& constraint);
  void push_through(Vertex w, const Piece& piece);
  void remember(Edge edge, const Piece& piece);
  Constraint unconstrain(Edge edge);
  Vertex insert_crossing(Point p, std::uint32_t id, std::uint32_t hint);
  void insert_on(Edge edge, Point p, std::uint32_t id, Vertex& w);
  bool is_end(Vertex v, Edge edge) const { return v == t_.right(edge) || v == t_.left(edge); }
  bool splits_cleanly(Edge edge, Point p) const;
  Point at(Vertex v) const { return t_.at(v); }
  void count_split();

  // Whether w counts as on the piece.
  bool touches(Vertex w, const Piece& piece) const;

  // Whether p would advance the chain of the constraint's segment between its vertices u and v.
  bool advances(Point p, Vertex u, Vertex v, const Constraint& constraint) const;

  // The ends of the lowest input segment.
  std::pair<Point, Point> segment(const Constraint& constraint) const;

  const Pslg& pslg_;
  Triangulation& t_;
  const std::uint64_t max_splits_;
  Pacer& pacer_;
  std::vector<Constraint> constraints_;
  double surely_apart_ = 0;    // more than the snapping distance of any segment
  std::vector<Piece> pieces_;  // still to insert, last one first
  std::uint32_t crossings_ = 0;
  std::uint64_t splits_ = 0;
};

}  // namespace weft
