// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/domain/segment_inserter.h"

#include <algorithm>
#include <array>
#include <string>

#include "engine/domain/crossing.h"
#include "engine/domain/snapping.h"

namespace weft {
namespace {

// Whether ab and cd cross in a point interior to both.
bool properly_cross(Point a, Point b, Point c, Point d) {
  return orientation_exact(a, b, c) * orientation_exact(a, b, d) < 0 &&
         orientation_exact(c, d, a) * orientation_exact(c, d, b) < 0;
}

bool is_end(Cdt::Vertex_handle v, Cdt::Edge edge) {
  const auto [right, left] = ends(edge);
  return v == right || v == left;
}

// Whether p, which lies near an edge, can be inserted as if it lay on it: joining it to the four
// corners around gives counter-clockwise triangles, and the edges to the corners are Delaunay.
bool splits_cleanly(Cdt::Edge edge, Point p) {
  const Cdt::Face_handle beyond = edge.first->neighbor(edge.second);
  const Point r = at(ends(edge).right);
  const Point l = at(ends(edge).left);
  const Point near = at(edge.first->vertex(edge.second));
  const Point far = at(beyond->vertex(beyond->index(edge.first)));
  return orientation_exact(near, r, p) > 0 && orientation_exact(near, p, l) > 0 &&
         orientation_exact(far, p, r) > 0 && orientation_exact(far, l, p) > 0 &&
         in_circle_exact(near, r, l, p) && in_circle_exact(far, l, r, p);
}

}  // namespace

void SegmentInserter::insert_all() {
  for (std::uint32_t i = 0; i < pslg_.segments.size(); ++i) {
    const Segment& s = pslg_.segments[i];
    push(vertex_of_point_[s.a], vertex_of_point_[s.b],
         {i, s.marker, s.marker != 0 ? i : kNone, true});
    while (!pieces_.empty()) {
      const Piece piece = pieces_.back();
      pieces_.pop_back();
      insert(piece);
    }
  }
}

// Looks from both ends in turn, so that a hub of many segments does not cost its degree each time.
void SegmentInserter::insert(const Piece& piece) {
  LineProbe from_u(cdt_, piece.u, piece.v);
  LineProbe from_v(cdt_, piece.v, piece.u);
  for (bool u_is_next = true;; u_is_next = !u_is_next) {
    pacer_.step();
    LineProbe& probe = u_is_next ? from_u : from_v;
    switch (probe.turn()) {
      case LineProbe::Sees::kNothingYet:
        break;
      case LineProbe::Sees::kEdge: {
        const Cdt::Edge mirror = cdt_.mirror_edge(probe.edge());
        // The edge is there, but may pass by a vertex within the snapping distance, a corner of
        // the needle beside it.
        for (const Cdt::Edge& side : {probe.edge(), mirror}) {
          const Vertex apex = side.first->vertex(side.second);
          if (!cdt_.is_infinite(apex) && touches(apex, piece)) return push_through(apex, piece);
        }
        probe.edge().first->set_constraint(probe.edge().second, true);
        mirror.first->set_constraint(mirror.second, true);
        return remember(piece);
      }
      case LineProbe::Sees::kVertex:
        return push_through(probe.vertex(), piece);
      case LineProbe::Sees::kCrossing:
        return walk(probe, piece);
    }
  }
}

// Follows the piece through the triangles that it crosses, up to the first thing in its way.
void SegmentInserter::walk(const LineProbe& probe, const Piece& piece) {
  const Point a = at(probe.from());
  const Point b = at(probe.to());

  auto [face, i] = probe.edge();
  auto [right, left] = ends({face, i});
  if (touches(right, piece)) return push_through(right, piece);
  if (touches(left, piece)) return push_through(left, piece);
  for (;;) {
    pacer_.step();
    if (face->is_constrained(i)) return cross({face, i}, piece);
    const Cdt::Face_handle next = face->neighbor(i);
    const Vertex w = next->vertex(next->index(face));
    if (w == probe.to()) {
      cdt_.insert_constraint(probe.from(), w);
      return remember(piece);
    }
    const int side = orientation_exact(a, b, at(w));
    if (side == 0 || touches(w, piece)) return push_through(w, piece);
    // w replaces the end on its side; the next edge crossed is opposite to the one replaced.
    Vertex& replaced = side > 0 ? left : right;
    face = next;
    i = next->index(replaced);
    replaced = w;
  }
}

// Makes the piece and the constrained edge that it crosses meet in a vertex.
void SegmentInserter::cross(Cdt::Edge edge, const Piece& piece) {
  const auto [right, left] = ends(edge);
  const auto [a, b] = segment(piece.constraint);
  const auto [c, d] = segment(constraints_.at(right->info(), left->info()));
  const double snap = std::max(snap_distance(a, b), snap_distance(c, d));
  if (properly_cross(a, b, c, d) && meet_at(crossing_point(a, b, c, d), snap, edge, piece)) return;
  // Rounding has bent the two, so that they cross elsewhere than their segments, if these do.
  const Point p = crossing_point(at(piece.u), at(piece.v), at(right), at(left));
  if (!meet_at(p, snap, edge, piece)) meet_in_new_vertex(p, edge, piece);
}

// Declines where one of the two would not advance.
bool SegmentInserter::meet_at(Point p, double snap, Cdt::Edge edge, const Piece& piece) {
  const auto [right, left] = ends(edge);
  const Constraint& other = constraints_.at(right->info(), left->info());
  std::array<Vertex, 4> nearest{piece.u, piece.v, right, left};
  std::stable_sort(nearest.begin(), nearest.end(),
                   [p](Vertex v, Vertex w) { return distance(at(v), p) < distance(at(w), p); });
  for (const Vertex w : nearest) {
    if (distance(at(w), p) > snap) break;
    if (is_end(w, edge) ? !advances(at(w), piece.u, piece.v, piece.constraint)
                        : !advances(at(w), right, left, other))
      continue;
    meet_in_end(w, edge, piece);
    return true;
  }
  if (!advances(p, piece.u, piece.v, piece.constraint) || !advances(p, right, left, other))
    return false;
  meet_in_new_vertex(p, edge, piece);
  return true;
}

// w is an end of one of the two; the other one is led through it.
void SegmentInserter::meet_in_end(Vertex w, Cdt::Edge edge, const Piece& piece) {
  if (is_end(w, edge)) return push_through(w, piece);
  const auto [right, left] = ends(edge);
  push(piece.u, piece.v, piece.constraint);
  push_through(w, {right, left, unconstrain(edge)});
}

void SegmentInserter::meet_in_new_vertex(Point p, Cdt::Edge edge, const Piece& piece) {
  const auto [right, left] = ends(edge);
  const auto id = static_cast<std::uint32_t>(pslg_.points.size()) + crossings_;
  Vertex w;
  if (splits_cleanly(edge, p)) {
    // As if p lay on the edge. The general way gives the same; this one spares the triangles
    // around a long edge from losing its constraint and getting it back.
    count_split();
    w = cdt_.insert({p.x, p.y}, Cdt::EDGE, edge.first, edge.second);
    w->info() = id;
    const Constraint other = constraints_.take(right->info(), left->info());
    constraints_.add(right->info(), id, other);
    constraints_.add(id, left->info(), other);
  } else {
    const Cdt::Face_handle hint = edge.first;
    const Constraint other = unconstrain(edge);
    w = insert_crossing(p, id, hint);
    push_through(w, {right, left, other});
  }
  if (w->info() == id) ++crossings_;
  push_through(w, piece);
  pacer_.require(estimated_bytes(pslg_.points.size() + crossings_, constraints_.size()));
}

// Inserts p, or finds the vertex that is there already.
SegmentInserter::Vertex SegmentInserter::insert_crossing(Point p, std::uint32_t id,
                                                         Cdt::Face_handle hint) {
  Cdt::Locate_type type = Cdt::VERTEX;
  int i = 0;
  const Cdt::Face_handle face = cdt_.locate({p.x, p.y}, type, i, hint);
  if (type == Cdt::VERTEX) return face->vertex(i);
  if (type != Cdt::EDGE || !face->is_constrained(i)) {
    const Vertex w = cdt_.insert({p.x, p.y}, type, face, i);
    w->info() = id;
    return w;
  }
  const auto [right, left] = ends({face, i});
  const Constraint third = constraints_.take(right->info(), left->info());
  const Vertex w = cdt_.insert({p.x, p.y}, type, face, i);
  w->info() = id;
  constraints_.add(right->info(), id, third);
  constraints_.add(id, left->info(), third);
  return w;
}

void SegmentInserter::push(Vertex u, Vertex v, const Constraint& constraint) {
  if (u != v) pieces_.push_back({u, v, constraint});
}

// u to w comes first.
void SegmentInserter::push_through(Vertex w, const Piece& piece) {
  count_split();
  push(w, piece.v, piece.constraint);
  push(piece.u, w, piece.constraint);
}

// The piece has become an edge.
void SegmentInserter::remember(const Piece& piece) {
  constraints_.add(piece.u->info(), piece.v->info(), piece.constraint);
}

SegmentInserter::Constraint SegmentInserter::unconstrain(Cdt::Edge edge) {
  const auto [right, left] = ends(edge);
  cdt_.remove_constrained_edge(edge.first, edge.second);
  return constraints_.take(right->info(), left->info());
}

void SegmentInserter::count_split() {
  if (++splits_ > max_splits_)
    throw Stopped{{ErrorCode::kLimitExceeded, "domain.segments",
                   "the segments cross and overlap more than " + std::to_string(max_splits_) +
                       " times, which is the limit"}};
}

bool SegmentInserter::touches(Vertex w, const Piece& piece) const {
  const auto [a, b] = segment(piece.constraint);
  return distance_to_line(at(w), a, b) <= snap_distance(a, b) &&
         advances(at(w), piece.u, piece.v, piece.constraint);
}

bool SegmentInserter::advances(Point p, Vertex u, Vertex v, const Constraint& constraint) const {
  const auto [a, b] = segment(constraint);
  const auto [low, high] = std::minmax({progress(at(u), a, b), progress(at(v), a, b)});
  const double here = progress(p, a, b);
  return low < here && here < high;
}

std::pair<Point, Point> SegmentInserter::segment(const Constraint& constraint) const {
  const Segment& s = pslg_.segments[constraint.segment];
  return {pslg_.points[s.a], pslg_.points[s.b]};
}

}  // namespace weft
