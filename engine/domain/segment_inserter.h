// SPDX-License-Identifier: GPL-3.0-or-later
// Leads the segments of a PSLG through the triangulation of its points, each as a chain of
// constrained edges. See arrangement.h for how segments meet.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "engine/domain/arrangement.h"
#include "engine/domain/cdt.h"
#include "engine/domain/edge_constraints.h"
#include "engine/domain/line_probe.h"
#include "engine/domain/pacer.h"
#include "engine/domain/pslg.h"

namespace weft {

class SegmentInserter {
 public:
  // `vertex_of_point[i]` is the vertex of pslg.points[i]. All references must outlive the inserter.
  SegmentInserter(const Pslg& pslg, const std::vector<Cdt::Vertex_handle>& vertex_of_point,
                  Cdt& cdt, std::uint64_t max_splits, Pacer& pacer)
      : pslg_(pslg),
        vertex_of_point_(vertex_of_point),
        cdt_(cdt),
        max_splits_(max_splits),
        pacer_(pacer) {}

  // Throws Stopped.
  void insert_all();

  const EdgeConstraints& constraints() const { return constraints_; }
  std::uint32_t crossings() const { return crossings_; }  // vertices made where segments cross

 private:
  using Constraint = Arrangement::Constraint;
  using Vertex = Cdt::Vertex_handle;

  // A part of one or more input segments that is to become an edge, or several.
  struct Piece {
    Vertex u, v;
    Constraint constraint;
  };

  void insert(const Piece& piece);
  void walk(const LineProbe& probe, const Piece& piece);
  void cross(Cdt::Edge edge, const Piece& piece);
  bool meet_at(Point p, double snap, Cdt::Edge edge, const Piece& piece);
  void meet_in_end(Vertex w, Cdt::Edge edge, const Piece& piece);
  void meet_in_new_vertex(Point p, Cdt::Edge edge, const Piece& piece);

  void push(Vertex u, Vertex v, const Constraint& constraint);
  void push_through(Vertex w, const Piece& piece);
  void remember(const Piece& piece);
  Constraint unconstrain(Cdt::Edge edge);
  Vertex insert_crossing(Point p, std::uint32_t id, Cdt::Face_handle hint);
  void count_split();

  // Whether w counts as on the piece.
  bool touches(Vertex w, const Piece& piece) const;

  // Whether p would advance the chain of the constraint's segment between its vertices u and v.
  bool advances(Point p, Vertex u, Vertex v, const Constraint& constraint) const;

  // The ends of the lowest input segment.
  std::pair<Point, Point> segment(const Constraint& constraint) const;

  const Pslg& pslg_;
  const std::vector<Vertex>& vertex_of_point_;
  Cdt& cdt_;
  const std::uint64_t max_splits_;
  Pacer& pacer_;
  EdgeConstraints constraints_;
  std::vector<Piece> pieces_;  // still to insert, last one first
  std::uint32_t crossings_ = 0;
  std::uint64_t splits_ = 0;
};

}  // namespace weft
