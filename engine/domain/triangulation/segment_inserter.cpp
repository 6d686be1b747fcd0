// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/triangulation/segment_inserter.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/domain/arrangement/crossing.h"
#include "engine/domain/arrangement/snapping.h"
#include "engine/domain/arrangement/strip_search.h"
#include "engine/domain/tolerance.h"

namespace weft {
namespace {

// Whether ab and cd cross in a point interior to both.
bool properly_cross(Point a, Point b, Point c, Point d) {
  return orientation_exact(a, b, c) * orientation_exact(a, b, d) < 0 &&
         orientation_exact(c, d, a) * orientation_exact(c, d, b) < 0;
}

}  // namespace

SegmentInserter::SegmentInserter(const Pslg& pslg, const std::vector<Point>& points,
                                 Triangulation& triangulation, double spacing,
                                 std::uint64_t max_splits, Merging& merging, StopPoller& poller)
    : pslg_(pslg),
      points_(points),
      t_(triangulation),
      spacing_(spacing),
      max_splits_(max_splits),
      merging_(merging),
      poller_(poller),
      tolerance2_(merging.tolerance * merging.tolerance),
      least_tolerance_(std::min(merging.tolerance, least_tolerance(pslg))),
      rounding_(0x1p-10 * least_tolerance(pslg)) {  // 4 to 8 units in the last place
  constraints_.reserve(pslg.segments.size());
}

void SegmentInserter::insert_all() {
  for (std::uint32_t i = 0; i < pslg_.segments.size(); ++i) {
    const Segment& s = pslg_.segments[i];
    const Piece whole{t_.vertex_of(s.a),
                      t_.vertex_of(s.b),
                      {i, s.marker, s.marker != 0 ? i : kNone, true, s.area}};
    if (whole.u == whole.v) {
      if (pslg_.points[s.a] != pslg_.points[s.b]) shrunk_.emplace_back(s.a, s.b);
      continue;
    }
    insert(whole);
    insert_pieces();
  }
  separate();
  count_faces();
}

void SegmentInserter::merge(Constraint& into, const Constraint& other) {
  into.segment = std::min(into.segment, other.segment);
  if (gives_marker_before(other.marker_segment, into.marker_segment)) {
    into.marker_segment = other.marker_segment;
    into.marker = other.marker;
  }
  into.odd = into.odd != other.odd;
  into.areas = joined(into.areas, other.areas);
}

// Lines come before borders of areas, because they are there for their marker. kNone comes last.
bool SegmentInserter::gives_marker_before(std::uint32_t s, std::uint32_t t) const {
  if (s == kNone || t == kNone) return s < t;
  const bool is_line = pslg_.segments[s].area == kNone;
  return is_line == (pslg_.segments[t].area == kNone) ? s < t : is_line;
}

// The areas of both lists; two borders of one area cancel.
std::uint32_t SegmentInserter::joined(std::uint32_t first, std::uint32_t second) {
  if (first == kNone) return second;
  if (second == kNone) return first;
  if (first == second) return kNone;
  area_joins_.push_back({first, second});
  return static_cast<std::uint32_t>(pslg_.areas.size() + area_joins_.size() - 1);
}

void SegmentInserter::insert_pieces() {
  while (!pieces_.empty()) {
    const Piece piece = pieces_.back();
    pieces_.pop_back();
    insert(piece);
  }
}

// Leads every edge through the vertices beside it, until none is left: an edge that was inserted
// early did not see the vertices that came later, nor any vertex that is not a corner of the
// triangles that it crosses.
void SegmentInserter::separate() {
  StripSearch strip(t_, 0.5 * merging_.tolerance, poller_);
  for (bool is_done = false; !is_done;) {
    is_done = true;
    for (std::uint32_t f = 0; f < t_.faces(); ++f) {
      poller_.step();
      strip.set_spacing(crossings_ == 0 ? spacing_ : merging_.tolerance);
      if (strip.is_clear(f)) [[likely]]
        continue;
      for (int i = 0; i < 3; ++i) {
        const Edge edge{f, i};
        if (t_.constraint(edge) == kNone) continue;
        if (strip.is_clear(edge)) continue;
        const Vertex apex = t_.apex(edge);
        const Piece piece{t_.right(edge), t_.left(edge), constraints_[t_.constraint(edge)]};
        const auto is_touched = [&](Vertex v) { return touches(v, piece); };
        const Vertex w = touches(apex, piece) ? apex : strip.nearest(edge, is_touched);
        if (w == Triangulation::kInfinite) continue;
        unconstrain(edge);
        merge_through(w, piece);
        insert_pieces();
        is_done = false;
        i = -1;  // another face by now
      }
    }
  }
}

// Looks from both ends in turn, so that a vertex of high degree does not cost its degree each time.
void SegmentInserter::insert(const Piece& piece) {
  poller_.step();
  if (const Edge edge = t_.find_edge(piece.u, piece.v); edge.face != kNone) {
    // The edge is there, but a vertex may lie within the snapping distance of it: the apex of a
    // needle beside it.
    for (const Edge& side : {edge, t_.mirror(edge)}) {
      const Vertex apex = t_.apex(side);
      if (apex != Triangulation::kInfinite && touches(apex, piece))
        return merge_through(apex, piece);
    }
    return remember(edge, piece);
  }
  LineProbe from_u(t_, piece.u, piece.v);
  LineProbe from_v(t_, piece.v, piece.u);
  for (bool u_is_next = true;; u_is_next = !u_is_next) {
    poller_.step();
    LineProbe& probe = u_is_next ? from_u : from_v;
    switch (probe.turn()) {
      case LineProbe::Sees::kNothingYet:
      case LineProbe::Sees::kEdge:
        break;
      case LineProbe::Sees::kVertex:
        return merge_through(probe.vertex(), piece);
      case LineProbe::Sees::kCrossing:
        return walk(probe, piece);
    }
  }
}

// Follows the piece through the triangles that it crosses, up to the first thing in its way.
void SegmentInserter::walk(const LineProbe& probe, const Piece& piece) {
  const Point a = at(probe.from());
  const Point b = at(probe.to());

  Edge edge = probe.edge();
  Vertex right = t_.right(edge);
  Vertex left = t_.left(edge);
  if (touches(right, piece)) return merge_through(right, piece);
  if (touches(left, piece)) return merge_through(left, piece);
  for (;;) {
    poller_.step();
    if (t_.constraint(edge) != kNone) return cross(edge, piece);
    const Edge next = t_.mirror(edge);
    const Vertex w = t_.apex(next);
    if (w == probe.to()) return remember(t_.insert_edge(probe.from(), w, probe.edge()), piece);
    const int side = orientation(a, b, at(w));
    if (side == 0 || touches(w, piece)) return merge_through(w, piece);
    // w replaces the end on its side; the next edge crossed is opposite to the one replaced.
    Vertex& replaced = side > 0 ? left : right;
    edge = {next.face, t_.index(next.face, replaced)};
    replaced = w;
  }
}

bool SegmentInserter::splits_cleanly(Edge edge, Point p) const {
  const Edge mirror = t_.mirror(edge);
  if (t_.apex(edge) == kNone || t_.apex(mirror) == kNone) return false;
  const Point r = at(t_.right(edge));
  const Point l = at(t_.left(edge));
  const Point near = at(t_.apex(edge));
  const Point far = at(t_.apex(mirror));
  return orientation(near, r, p) > 0 && orientation(near, p, l) > 0 && orientation(far, p, r) > 0 &&
         orientation(far, l, p) > 0 && in_circle(near, r, l, p) > 0 && in_circle(far, l, r, p) > 0;
}

// Makes the piece and the constrained edge that it crosses meet in a vertex.
void SegmentInserter::cross(Edge edge, const Piece& piece) {
  const Point u = at(piece.u), v = at(piece.v), r = at(t_.right(edge)), l = at(t_.left(edge));
  const auto [a, b] = segment(piece.constraint);
  const auto [c, d] = segment(constraints_[t_.constraint(edge)]);
  if (properly_cross(a, b, c, d)) {
    const Point p = crossing_point(a, b, c, d);
    const bool is_near = distance_to_line(p, u, v) < merging_.tolerance &&
                         distance_to_line(p, r, l) < merging_.tolerance;
    if (is_near && meet_at(p, edge, piece)) return;
  }
  // Merging may have bent the two: they may cross elsewhere than their segments do, or these may
  // not cross at all.
  const Point p = crossing_point(u, v, r, l);
  if (!meet_at(p, edge, piece)) meet_in_new_vertex(p, edge, piece);
}

// Declines if one of the two would not become shorter.
bool SegmentInserter::meet_at(Point p, Edge edge, const Piece& piece) {
  const Vertex right = t_.right(edge);
  const Vertex left = t_.left(edge);
  const Vertex w = near(p);
  if (w == Triangulation::kInfinite) {
    if (!shortens(piece.u, p, piece.v) || !shortens(right, p, left)) return false;
    meet_in_new_vertex(p, edge, piece);
  } else {
    if (!shortens_or_is_end(piece.u, w, piece.v) || !shortens_or_is_end(right, w, left))
      return false;
    meet_in(w, edge, piece);
  }
  return true;
}

// Leads both through w, unless w is an end.
void SegmentInserter::meet_in(Vertex w, Edge edge, const Piece& piece) {
  if (w == piece.u || w == piece.v) {
    push(piece.u, piece.v, piece.constraint);
  } else {
    merge_through(w, piece);
  }
  if (is_end(w, edge)) return;
  const Vertex right = t_.right(edge);
  const Vertex left = t_.left(edge);
  merge_through(w, {right, left, unconstrain(edge)});
}

// All vertices are in the grid from the first crossing on.
SegmentInserter::Vertex SegmentInserter::near(Point p) {
  if (!vertices_) {
    vertices_.emplace(merging_.tolerance);
    for (Vertex v = 0; v < t_.vertices(); ++v) {
      poller_.step();
      if (t_.exists(v)) vertices_->insert(v, at(v));
    }
  }
  return vertices_->nearest(p);
}

void SegmentInserter::meet_in_new_vertex(Point p, Edge edge, const Piece& piece) {
  const Vertex right = t_.right(edge);
  const Vertex left = t_.left(edge);
  const auto id = static_cast<std::uint32_t>(pslg_.points.size()) + crossings_;
  Vertex w;
  if (splits_cleanly(edge, p)) {
    // Inserts p as if it lay on the edge. The general case gives the same; this one does not remove
    // the constraint of a long edge and put it back.
    count_split();
    insert_on(edge, p, id, w);
  } else {
    const std::uint32_t hint = edge.face;
    const Constraint other = unconstrain(edge);
    w = insert_crossing(p, id, hint);
    push_through(w, {right, left, other});
  }
  if (t_.id(w) == id) {
    ++crossings_;
    vertices_->insert(w, p);
  }
  push_through(w, piece);
  poller_.require(estimated_bytes(pslg_.points.size() + crossings_,
                                  constraints_.size() + area_joins_.size() / 4));
}

// Inserts p, or finds the vertex that is there already.
SegmentInserter::Vertex SegmentInserter::insert_crossing(Point p, std::uint32_t id,
                                                         std::uint32_t hint) {
  const Triangulation::Place place = t_.locate(p, hint);
  if (place.at == Triangulation::At::kVertex) return t_.apex(place.edge);
  if (place.at != Triangulation::At::kEdge || t_.constraint(place.edge) == kNone)
    return t_.insert(p, id, place);
  Vertex w;
  insert_on(place.edge, p, id, w);
  return w;
}

// Splits a constrained edge. Its halves may come to differ from it.
void SegmentInserter::insert_on(Edge edge, Point p, std::uint32_t id, Vertex& w) {
  const Vertex right = t_.right(edge);
  const Constraint constraint = constraints_[t_.constraint(edge)];
  w = t_.insert(p, id, {Triangulation::At::kEdge, edge});
  t_.constrain(t_.find_edge(right, w), static_cast<std::uint32_t>(constraints_.size()));
  constraints_.push_back(constraint);
}

void SegmentInserter::push(Vertex u, Vertex v, const Constraint& constraint) {
  if (u != v) pieces_.push_back({u, v, constraint});
}

// Queues both halves; the one from u to w is taken first.
void SegmentInserter::push_through(Vertex w, const Piece& piece) {
  count_split();
  push(w, piece.v, piece.constraint);
  push(piece.u, w, piece.constraint);
}

// The same, and records how far that moves the segment.
void SegmentInserter::merge_through(Vertex w, const Piece& piece) {
  const auto [a, b] = input_segment(piece.constraint);
  if (const double off = distance_to_segment(at(w), a, b); off > rounding_) {
    add_move(merging_, off, at(w));
    is_moved_.resize(pslg_.segments.size());
    if (!is_moved_[piece.constraint.segment]) ++merging_.segments;
    is_moved_[piece.constraint.segment] = true;
  }
  push_through(w, piece);
}

// The piece has become an edge.
void SegmentInserter::remember(Edge edge, const Piece& piece) {
  if (const std::uint32_t constraint = t_.constraint(edge); constraint != kNone) {
    Constraint& other = constraints_[constraint];
    const auto [a, b] = input_segment(other);
    const auto [c, d] = input_segment(piece.constraint);
    const bool overlap = orientation_exact(a, b, c) == 0 && orientation_exact(a, b, d) == 0;
    if (!overlap && other.segment != piece.constraint.segment)
      coincident_.emplace_back(piece.u, piece.v);
    return merge(other, piece.constraint);
  }
  t_.constrain(edge, static_cast<std::uint32_t>(constraints_.size()));
  constraints_.push_back(piece.constraint);
}

SegmentInserter::Constraint SegmentInserter::unconstrain(Edge edge) {
  const Constraint constraint = constraints_[t_.constraint(edge)];
  t_.unconstrain(edge);
  return constraint;
}

void SegmentInserter::count_split() {
  if (++splits_ > max_splits_)
    throw Stopped{{ErrorCode::kLimitExceeded, "domain.segments",
                   "the segments cross and overlap more than " + std::to_string(max_splits_) +
                       " times, which is the limit"}};
}

// True within the tolerance of the input segment, however far earlier merges have led the piece
// from it, or within half the least tolerance of the piece. A vertex that is within the tolerance
// of the segment is within twice that of a piece whose ends are so, too.
bool SegmentInserter::touches(Vertex w, const Piece& piece) const {
  const Point u = at(piece.u), v = at(piece.v), p = at(w);
  const double x = v.x - u.x, y = v.y - u.y;
  const double cross = x * (p.y - u.y) - y * (p.x - u.x);
  const double length2 = x * x + y * y;
  if (cross * cross > 4 * tolerance2_ * length2) [[likely]]
    return false;
  // Squares of tiny coordinates underflow, lengths do not.
  const double off = std::fabs(cross) / std::sqrt(length2);
  if (off >= 2 * merging_.tolerance || !shortens(piece.u, p, piece.v)) return false;
  if (off < 0.5 * least_tolerance_) return true;
  const auto [a, b] = input_segment(piece.constraint);
  return distance_to_segment(p, a, b) < merging_.tolerance;
}

bool SegmentInserter::shortens(Vertex u, Point p, Vertex v) const {
  const double whole2 = distance2(at(u), at(v));
  return distance2(at(u), p) < whole2 && distance2(p, at(v)) < whole2;
}

// Counts the faces that lay between segments and are gone.
void SegmentInserter::count_faces() {
  const Connectivity loops = connectivity(shrunk_, poller_);
  const Connectivity runs = connectivity(coincident_, poller_);
  merging_.vanished_faces = loops.loops + runs.components;
  if (loops.loops > 0) {
    merging_.vanished_at = at(t_.vertex_of(shrunk_[loops.first_loop].first));
  } else if (runs.components > 0) {
    merging_.vanished_at = at(coincident_.front().first);
  }
}

std::pair<Point, Point> SegmentInserter::segment(const Constraint& constraint) const {
  const Segment& s = pslg_.segments[constraint.segment];
  return {points_[s.a], points_[s.b]};
}

std::pair<Point, Point> SegmentInserter::input_segment(const Constraint& constraint) const {
  const Segment& s = pslg_.segments[constraint.segment];
  return {pslg_.points[s.a], pslg_.points[s.b]};
}

}  // namespace weft
