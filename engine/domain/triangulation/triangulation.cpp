// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/triangulation/triangulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "engine/domain/arrangement/snapping.h"
#include "engine/domain/triangulation/hilbert.h"

namespace weft {
namespace {

// A biased randomised insertion order (Amenta, Choi, Rote, "Incremental constructions con BRIO",
// 2003): rounds of doubling size, each along the Hilbert curve. The round comes from a hash of the
// rank, so the order is the same on every run.
constexpr unsigned kRounds = 13;
unsigned insertion_round(std::uint64_t rank) {
  std::uint64_t h = (rank + 1) * 0x9e3779b97f4a7c15u;
  h = (h ^ h >> 30) * 0xbf58476d1ce4e5b9u;
  h = (h ^ h >> 27) * 0x94d049bb133111ebu;
  h ^= h >> 31;
  const auto ones = static_cast<unsigned>(__builtin_ctzll(~h));
  return ones < kRounds - 1 ? kRounds - 1 - ones : 0;
}

}  // namespace

void Triangulation::build(const std::vector<Point>& points, std::uint32_t a, std::uint32_t b,
                          std::uint32_t c) {
  id_ = hilbert_order(points, poller_);
  const auto n = static_cast<std::uint32_t>(points.size());
  points_.resize(n);
  vertex_of_point_.resize(n);
  face_of_.assign(n, kNone);
  for (Vertex v = 0; v < n; ++v) {
    poller_.step();
    points_[v] = points[id_[v]];
    vertex_of_point_[id_[v]] = v;
  }
  faces_.reserve(2 * std::size_t{n});  // 2 n - 2 at most, the infinite ones with them
  make_first_triangle(vertex_of(a), vertex_of(b), vertex_of(c));

  Vertex last = vertex_of(a);
  for (const Vertex next : insertion_order()) {
    poller_.step();
    if (exists(next)) continue;
    // The walk begins at the nearest of the vertices before it along the curve, if that one is
    // near.
    constexpr Vertex kLookBack = 16;
    Vertex near = last;
    for (Vertex back = next; back-- > 0 && next - back <= kLookBack;) {
      if (!exists(back)) continue;
      near = back;
      break;
    }
    insert_delaunay(next, face_of_[near]);
    if (exists(next)) last = next;
  }
  constraints_.reserve(faces_.capacity());
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    poller_.step();
    constraints_.push_back({{kNone, kNone, kNone}});
  }
}

// All vertices: by round, and in a round along the curve.
std::vector<Triangulation::Vertex> Triangulation::insertion_order() const {
  const auto n = static_cast<std::uint32_t>(points_.size());
  std::array<std::uint32_t, kRounds + 1> start{};
  std::vector<std::uint8_t> round(n);
  for (Vertex v = 0; v < n; ++v) {
    poller_.step();
    round[v] = static_cast<std::uint8_t>(insertion_round(v));
    ++start[round[v] + 1];
  }
  for (unsigned r = 0; r < kRounds; ++r) start[r + 1] += start[r];
  std::vector<Vertex> sequence(n);
  for (Vertex v = 0; v < n; ++v) {
    poller_.step();
    sequence[start[round[v]]++] = v;
  }
  return sequence;
}

// The triangle of three vertices, and the three infinite faces around it.
void Triangulation::make_first_triangle(Vertex u, Vertex v, Vertex w) {
  if (orientation(at(u), at(v), at(w)) < 0) std::swap(v, w);
  nearest2_ = std::min({distance2(at(u), at(v)), distance2(at(v), at(w)), distance2(at(w), at(u))});
  faces_.push_back({{u, v, w}, {}});
  faces_.push_back({{w, v, kInfinite}, {}});
  faces_.push_back({{u, w, kInfinite}, {}});
  faces_.push_back({{v, u, kInfinite}, {}});
  for (int i = 0; i < 3; ++i) {
    const auto f = static_cast<std::uint32_t>(i + 1);
    link(0, i, pack(f, 2));
    link(f, 1, pack(static_cast<std::uint32_t>(ccw(i) + 1), 0));
  }
  face_of_[u] = face_of_[v] = face_of_[w] = 0;
}

// Inserts v into the Delaunay triangulation, or makes it stand for the vertex that is there.
void Triangulation::insert_delaunay(Vertex v, std::uint32_t start) {
  const Point p = points_[v];
  Vertex coincident = kNone;
  const std::uint32_t first = find_conflict(p, start, coincident);
  if (coincident != kNone) {
    vertex_of_point_[id_[v]] = coincident;
    if (id_[v] < id_[coincident]) std::swap(id_[v], id_[coincident]);
    return;
  }
  // The nearest of the vertices so far is on the border of the cavity.
  if (cavity_.find(faces_.data(), points_.data(), p, first)) [[likely]] {
    nearest2_ = std::min(nearest2_, cavity_.nearest2());
    return fill_cavity(v, cavity_.faces(), cavity_.size(), cavity_.border());
  }
  find_cavity(p, first);
  for (const Border& edge : border_)
    if (edge.from != kInfinite) nearest2_ = std::min(nearest2_, distance2(p, at(edge.from)));
  const std::size_t count = dead_.size();
  dead_.resize(count + 3);
  border_.push_back(border_[0]);
  fill_cavity(v, dead_.data(), count, border_.data());
}

// Collects the faces in conflict with p in dead_, and the edges around them in border_: any number
// of them, infinite ones, too. The faces form a tree, because no vertex is inside the cavity. So
// none is met twice, none has to be marked, and the border comes out counter-clockwise.
void Triangulation::find_cavity(Point p, std::uint32_t first) {
  dead_.assign(1, first);
  border_.clear();
  const Face& start = faces_[first];
  stack_.assign({start.neighbor[2], start.neighbor[1], start.neighbor[0]});
  while (!stack_.empty()) {
    poller_.step();
    const std::uint32_t h = stack_.back();
    stack_.pop_back();
    const Face& f = faces_[h >> 2];
    const int i = static_cast<int>(h & 3);
    if (conflicts(f, p)) {
      dead_.push_back(h >> 2);
      stack_.push_back(f.neighbor[cw(i)]);
      stack_.push_back(f.neighbor[ccw(i)]);
    } else {
      border_.push_back({f.vertex[cw(i)], h});
    }
  }
}

// Replaces the `count` faces of the cavity by those from v to each edge of its border, which are
// two more. REQUIRES: there is room for three more faces, and the border ends with its first edge
// once more.
void Triangulation::fill_cavity(Vertex v, std::uint32_t* dead, std::size_t count,
                                const Border* border) {
  for (std::size_t k = 0; k < 2; ++k) {
    dead[count++] = static_cast<std::uint32_t>(faces_.size());
    faces_.push_back({});
  }
  dead[count] = dead[0];
  Face* const faces = faces_.data();
  std::uint32_t previous = dead[count - 1];
  for (std::size_t k = 0; k < count; ++k) {
    poller_.step();
    const std::uint32_t current = dead[k];
    const auto [from, outside] = border[k];
    faces[current] = {{v, from, border[k + 1].from},
                      {outside, pack(dead[k + 1], 2), pack(previous, 1)}};
    faces[outside >> 2].neighbor[outside & 3] = pack(current, 0);
    if (from != kInfinite) face_of_[from] = current;
    previous = current;
  }
  face_of_[v] = dead[0];
}

// Walks to a face in conflict with p: one that contains it, or, outside the hull, one whose edge it
// sees. In each face the walk knows the edge that it came across. Which of the other two it crosses
// next is hard to predict, so both are tested without a branch.
std::uint32_t Triangulation::find_conflict(Point p, std::uint32_t start, Vertex& coincident) const {
  Edge e{start, 0};
  if (is_infinite(start)) e.i = index(start, kInfinite);
  if (orientation(at(right(e)), at(left(e)), p) < 0) {
    e = mirror(e);
    if (apex(e) == kInfinite) return e.face;
  } else if (apex(e) == kInfinite) {
    if (orientation(at(right(e)), at(left(e)), p) > 0) return start;
    e = mirror(e);
  }
  Point r = at(right(e)), l = at(left(e));
  for (;;) {
    poller_.step();
    const Face& face = faces_[e.face];
    const Point q = at(face.vertex[e.i]);
    const double lx = l.x - p.x, ly = l.y - p.y, qx = q.x - p.x, qy = q.y - p.y, rx = r.x - p.x,
                 ry = r.y - p.y;
    const double lq = lx * qy, ql = ly * qx, qr = qx * ry, rq = qy * rx;
    const double of_left = lq - ql, of_right = qr - rq;
    bool beyond_left = of_left < 0, beyond_right = of_right < 0;
    const bool left_unsure = std::fabs(of_left) <= orientation_error(lq, ql);
    const bool right_unsure = std::fabs(of_right) <= orientation_error(qr, rq);
    if (left_unsure | right_unsure) [[unlikely]] {
      // If p is a vertex of the face, one of the two is 0.
      for (const Vertex v : face.vertex)
        if (at(v) == p) {
          coincident = v;
          return e.face;
        }
      beyond_left = orientation_exact(l, q, p) < 0;
      beyond_right = orientation_exact(q, r, p) < 0;
    }
    if (!(beyond_left | beyond_right)) return e.face;
    e = unpack(face.neighbor[beyond_left ? ccw(e.i) : cw(e.i)]);
    r = beyond_left ? q : r;
    l = beyond_left ? l : q;
    if (faces_[e.face].vertex[e.i] == kInfinite) return e.face;
  }
}

std::uint32_t Triangulation::new_face() {
  faces_.push_back({});
  constraints_.push_back({{kNone, kNone, kNone}});
  return static_cast<std::uint32_t>(faces_.size() - 1);
}

void Triangulation::constrain(Edge e, std::uint32_t constraint) {
  const Edge m = mirror(e);
  constraints_[e.face].edge[e.i] = constraint;
  constraints_[m.face].edge[m.i] = constraint;
}

Triangulation::Edge Triangulation::find_edge(Vertex u, Vertex v) const {
  Edge turning[2];
  const Vertex center[2] = {u, v};
  const Vertex other[2] = {v, u};
  for (int k = 0; k < 2; ++k)
    turning[k] = {face_of_[center[k]], index(face_of_[center[k]], center[k])};
  const std::uint32_t first[2] = {turning[0].face, turning[1].face};
  for (int k = 0;; k ^= 1) {
    poller_.step();
    // The face of `turning` has its center as vertex i.
    auto& [f, i] = turning[k];
    const Face& face = faces_[f];
    if (face.vertex[ccw(i)] == other[k]) return {f, cw(i)};
    const std::uint32_t h = face.neighbor[ccw(i)];  // the edge at vertices cw(i) and i
    f = h >> 2;
    i = ccw(static_cast<int>(h & 3));
    if (f == first[k]) return {};
  }
}

// Replaces edge a-b of the faces abc and bad by c-d.
void Triangulation::flip(Edge e) {
  const std::uint32_t t = e.face;
  const int i = e.i;
  const auto [s, j] = mirror(e);
  Face& ft = faces_[t];
  Face& fs = faces_[s];
  const Vertex a = ft.vertex[ccw(i)], b = ft.vertex[cw(i)], c = ft.vertex[i], d = fs.vertex[j];
  const std::uint32_t ca = ft.neighbor[cw(i)], bc = ft.neighbor[ccw(i)];
  const std::uint32_t ad = fs.neighbor[ccw(j)], db = fs.neighbor[cw(j)];
  OnEdges& ct = constraints_[t];
  OnEdges& cs = constraints_[s];
  const std::uint32_t on_ca = ct.edge[cw(i)], on_bc = ct.edge[ccw(i)];
  const std::uint32_t on_ad = cs.edge[ccw(j)], on_db = cs.edge[cw(j)];
  ft.vertex[i] = a;
  ft.vertex[ccw(i)] = d;
  ft.vertex[cw(i)] = c;
  fs.vertex[j] = b;
  fs.vertex[ccw(j)] = c;
  fs.vertex[cw(j)] = d;
  link(t, ccw(i), ca);
  link(t, cw(i), ad);
  link(s, ccw(j), db);
  link(s, cw(j), bc);
  ct.edge[ccw(i)] = on_ca;
  ct.edge[cw(i)] = on_ad;
  cs.edge[ccw(j)] = on_db;
  cs.edge[cw(j)] = on_bc;
  if (a != kInfinite) face_of_[a] = t;
  if (d != kInfinite) face_of_[d] = t;
  if (c != kInfinite) face_of_[c] = t;
  if (b != kInfinite) face_of_[b] = s;
}

// Flips edges (C. Lawson) until every edge without a constraint is Delaunay again; stack_ holds
// those that may not be.
void Triangulation::restore() {
  while (!stack_.empty()) {
    poller_.step();
    const Edge e = unpack(stack_.back());
    stack_.pop_back();
    if (constraint(e) != kNone) continue;
    const Edge m = mirror(e);
    // Edges of the hull stay. Edges to infinity are flipped where the hull would not be convex.
    if (apex(e) == kInfinite || apex(m) == kInfinite) continue;
    if (!conflicts(faces_[m.face], at(apex(e)))) continue;
    flip(e);
    for (const Edge f : {e, m}) {
      stack_.push_back(pack(f.face, ccw(f.i)));
      stack_.push_back(pack(f.face, cw(f.i)));
    }
  }
}

void Triangulation::unconstrain(Edge e) {
  constrain(e, kNone);
  stack_.assign(1, pack(e.face, e.i));
  restore();
}

// Digs along the segment by flips at u, and repairs what is left on both sides. Faces may be
// clockwise in the meantime. Source: Triangle's constrainededge() and delaunayfixup(). Their
// recursion is a stack here, because it may be as deep as the number of faces that the edge
// crosses.
Triangulation::Edge Triangulation::insert_edge(Vertex u, Vertex v, Edge first) {
  const auto origin_previous = [this](Edge e) {
    const Edge m = mirror(e);
    return Edge{m.face, ccw(m.i)};
  };
  const Point a = at(u), b = at(v);
  Edge e = first;
  flip(e);
  for (;;) {
    poller_.step();
    const Vertex far = right(e);
    const Edge other = origin_previous(e);
    if (far == v) {
      fix_up(e, false);
      fix_up(other, true);
      return find_edge(u, v);
    }
    // A fix-up leaves of e the edge between far and u, seen from the side that is dug next.
    if (orientation(a, b, at(far)) > 0) {
      fix_up(other, true);
      e = {e.face, cw(e.i)};
    } else {
      fix_up(e, false);
      e = other;
    }
    flip(e);
  }
}

// Makes the polygon at edge e Delaunay that lies on the dug side: `left_side` says which side of
// the segment that is.
void Triangulation::fix_up(Edge e, bool left_side) {
  stack_.assign(1, pack(e.face, e.i));
  while (!stack_.empty()) {
    poller_.step();
    e = unpack(stack_.back());
    stack_.pop_back();
    const Edge near{e.face, ccw(e.i)};
    const Edge far = mirror(near);
    if (apex(far) == kInfinite || constraint(near) != kNone) continue;
    const Point n = at(apex(near)), l = at(right(near)), r = at(left(near)), f = at(apex(far));
    if ((left_side ? orientation(n, l, f) : orientation(f, r, n)) <= 0) continue;
    if (orientation(r, l, f) > 0 && !conflicts(faces_[far.face], n)) continue;
    flip(near);
    stack_.push_back(pack(far.face, far.i));
    stack_.push_back(pack(e.face, cw(e.i)));
  }
}

// The stochastic walk of locate.cpp.
Triangulation::Place Triangulation::locate(Point p, std::uint32_t start) const {
  std::uint32_t random = 2463534242u;
  std::uint32_t f = start;
  if (is_infinite(f)) f = faces_[f].neighbor[index(f, kInfinite)] >> 2;
  for (;;) {
    poller_.step();
    random ^= random << 13;
    random ^= random >> 17;
    random ^= random << 5;
    const Face& face = faces_[f];
    int side[3];
    for (int i = 0; i < 3; ++i)
      side[i] = orientation(at(face.vertex[ccw(i)]), at(face.vertex[cw(i)]), p);
    int i = static_cast<int>(random % 3);
    int tried = 0;
    while (tried < 3 && side[i] >= 0) {
      ++tried;
      i = ccw(i);
    }
    if (tried == 3) {
      for (int k = 0; k < 3; ++k)
        if (at(face.vertex[k]) == p) return {At::kVertex, {f, k}};
      for (int k = 0; k < 3; ++k)
        if (side[k] == 0) return {At::kEdge, {f, k}};
      return {At::kFace, {f, 0}};
    }
    const Edge next = unpack(face.neighbor[i]);
    if (apex(next) == kInfinite) return {At::kOutside, next};
    f = next.face;
  }
}

Triangulation::Vertex Triangulation::insert(Point p, std::uint32_t id, const Place& place) {
  const auto v = static_cast<Vertex>(points_.size());
  points_.push_back(p);
  id_.push_back(id);
  face_of_.push_back(kNone);
  if (place.at == At::kEdge) {
    split_edge(place.edge, v);
  } else {
    split_face(place.edge.face, v);
  }
  stack_.clear();
  const std::uint32_t first = face_of_[v];
  Edge turn{first, index(first, v)};
  do {
    stack_.push_back(pack(turn.face, turn.i));
    const Edge next = mirror({turn.face, ccw(turn.i)});
    turn = {next.face, ccw(next.i)};
  } while (turn.face != first);
  restore();
  return v;
}

void Triangulation::split_face(std::uint32_t face, Vertex v) {
  const Face old = faces_[face];
  const OnEdges on = constraints_[face];
  const std::uint32_t part[3] = {face, new_face(), new_face()};
  for (int i = 0; i < 3; ++i) {
    const Vertex a = old.vertex[ccw(i)], b = old.vertex[cw(i)];
    faces_[part[i]] = {{v, a, b}, {kNone, pack(part[ccw(i)], 2), pack(part[cw(i)], 1)}};
    constraints_[part[i]] = {{on.edge[i], kNone, kNone}};
    if (a != kInfinite) face_of_[a] = part[i];
  }
  for (int i = 0; i < 3; ++i) link(part[i], 0, old.neighbor[i]);
  face_of_[v] = face;
}

// Splits the face on the near side, which leaves a flat one at the edge, and flips that away.
void Triangulation::split_edge(const Edge& edge, Vertex v) {
  const std::uint32_t on = constraint(edge);
  const Vertex from = right(edge), to = left(edge);
  if (on != kNone) constrain(edge, kNone);
  split_face(edge.face, v);
  flip(find_edge(from, to));
  if (on == kNone) return;
  constrain(find_edge(from, v), on);
  constrain(find_edge(v, to), on);
}

}  // namespace weft
