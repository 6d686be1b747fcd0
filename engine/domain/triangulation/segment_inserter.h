// SPDX-License-Identifier: Apache-2.0
// Leads the segments of a PSLG through the triangulation of its points, each as a chain of
// constrained edges. See arrangement.h for how segments meet.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "engine/domain/arrangement/arrangement.h"
#include "engine/domain/arrangement/line_probe.h"
#include "engine/domain/arrangement/merging.h"
#include "engine/domain/arrangement/point_grid.h"
#include "engine/domain/stop_poller.h"
#include "engine/domain/triangulation/triangulation.h"
#include "weft/pslg.h"

namespace weft {

class SegmentInserter {
 public:
  // `points` are those of the PSLG after merging (merge_points in merging.h), `triangulation` is
  // their triangulation. No two vertices are nearer to each other than `spacing`, which is at least
  // the tolerance. Adds to `merging`. All references must outlive the inserter.
  SegmentInserter(const Pslg& pslg, const std::vector<Point>& points, Triangulation& triangulation,
                  double spacing, std::uint64_t max_splits, Merging& merging, StopPoller& poller);

  // Afterwards constrained edges and vertices are apart as arrangement.h says. Throws Stopped.
  void insert_all();

  // The constraints, indexed as in the triangulation; some are no longer in use.
  std::vector<Arrangement::Constraint> take_constraints() { return std::move(constraints_); }
  std::vector<Arrangement::AreaJoin> take_area_joins() { return std::move(area_joins_); }
  std::uint32_t crossings() const { return crossings_; }  // vertices made where segments cross

 private:
  using Constraint = Arrangement::Constraint;
  using Vertex = Triangulation::Vertex;
  using Edge = Triangulation::Edge;

  // A part of one or more input segments that is to become one or several edges.
  struct Piece {
    Vertex u, v;
    Constraint constraint;
  };

  void insert_pieces();
  void separate();
  void insert(const Piece& piece);
  void walk(const LineProbe& probe, const Piece& piece);
  void cross(Edge edge, const Piece& piece);
  bool meet_at(Point p, Edge edge, const Piece& piece);
  void meet_in(Vertex w, Edge edge, const Piece& piece);
  void meet_in_new_vertex(Point p, Edge edge, const Piece& piece);
  void count_faces();

  void merge(Constraint& into, const Constraint& other);
  bool gives_marker_before(std::uint32_t s, std::uint32_t t) const;
  std::uint32_t joined(std::uint32_t first, std::uint32_t second);
  void push(Vertex u, Vertex v, const Constraint& constraint);
  void push_through(Vertex w, const Piece& piece);
  void merge_through(Vertex w, const Piece& piece);
  void remember(Edge edge, const Piece& piece);
  Constraint unconstrain(Edge edge);
  Vertex insert_crossing(Point p, std::uint32_t id, std::uint32_t hint);
  void insert_on(Edge edge, Point p, std::uint32_t id, Vertex& w);
  bool is_end(Vertex v, Edge edge) const { return v == t_.right(edge) || v == t_.left(edge); }
  bool splits_cleanly(Edge edge, Point p) const;
  Point at(Vertex v) const { return t_.at(v); }
  void count_split();

  // Whether w is so near that the piece must be led through it.
  bool touches(Vertex w, const Piece& piece) const;

  // Whether the parts from u to p and from p to v are both shorter than the straight line from u to
  // v. Insertion ends because of this condition.
  bool shortens(Vertex u, Point p, Vertex v) const;
  bool shortens_or_is_end(Vertex u, Vertex w, Vertex v) const {
    return w == u || w == v || shortens(u, at(w), v);
  }

  // The vertex to use for p; Triangulation::kInfinite if none is near.
  Vertex near(Point p);

  // The ends of the lowest input segment, after merging; then the original ones.
  std::pair<Point, Point> segment(const Constraint& constraint) const;
  std::pair<Point, Point> input_segment(const Constraint& constraint) const;

  const Pslg& pslg_;
  const std::vector<Point>& points_;
  Triangulation& t_;
  const double spacing_;  // of the vertices, as long as there is no crossing
  const std::uint64_t max_splits_;
  Merging& merging_;
  StopPoller& poller_;
  const double tolerance2_;
  const double least_tolerance_;
  const double rounding_;  // what a vertex on a segment may be off it
  std::vector<Constraint> constraints_;
  std::vector<Arrangement::AreaJoin> area_joins_;
  std::vector<Piece> pieces_;          // still to insert, last one first
  std::optional<PointGrid> vertices_;  // all of them, from the first crossing on
  std::vector<bool> is_moved_;         // per segment, from the first one on
  Edges shrunk_;                       // segments whose ends have merged, by points
  Edges coincident_;                   // edges on which segments have come to lie together
  std::uint32_t crossings_ = 0;
  std::uint64_t splits_ = 0;
};

}  // namespace weft
