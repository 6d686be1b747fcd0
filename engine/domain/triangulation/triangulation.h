// SPDX-License-Identifier: Apache-2.0
// A constrained Delaunay triangulation in plain arrays: 24 bytes per face, and 12 for what lies on
// its edges. Faces with the vertex kInfinite cover the plane outside the convex hull.
//
//   Triangulation t(poller);
//   t.build(points, a, b, c);                    // Delaunay
//   const auto e = t.find_edge(t.vertex_of(0), t.vertex_of(1));
//   if (e.face != kNone) t.constrain(e, 7);
//
// Laws that it obeys between two calls (checked by tests):
//   - finite faces are counter-clockwise, infinite ones have a hull edge, the hull to its right;
//   - mirror(mirror(e)) == e, and both sides of an edge have the same two vertices and the same
//     constraint;
//   - no two vertices coincide, and face_at(v) has vertex v;
//   - every edge without a constraint is Delaunay: no vertex that it can be seen from lies inside
//     the circle of a face beside it;
//   - if vertices lie on one circle, the diagonals are those of a symbolic perturbation, so the
//     faces depend only on the points and the constrained edges, not on the order in which they
//     came; only the numbers of faces and vertices depend on that order.
//
// Sources. Insertion by cavities: A. Bowyer, D. F. Watson, 1981. The perturbation is that of O.
// Devillers and M. Teillaud, "Perturbations and vertex removal in a 3D Delaunay triangulation",
// 2003, which CGAL has, too: lift the points to a paraboloid, and raise each by an infinitely small
// amount, more for points later in lexicographic order. A triangulation is the lower hull of the
// raised points. Because no four of these are on a plane, the hull is unique, a cavity is always a
// disk with all its vertices on the border, and a walk ends. Constrained edges: J. R. Shewchuk,
// "Triangle", 1996.
//
// All decisions are exact, see filtered.h. Not thread-safe. Every operation throws Stopped if
// the poller says so; the triangulation may then only be destroyed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/base/geometry.h"
#include "engine/domain/face.h"
#include "engine/domain/stop_poller.h"
#include "engine/domain/triangulation/filtered.h"
#include "engine/domain/triangulation/small_cavity.h"

namespace weft {

class Triangulation {
 public:
  using Vertex = std::uint32_t;
  static constexpr Vertex kInfinite = kNone;

  static constexpr int ccw(int i) { return weft::ccw(i); }
  static constexpr int cw(int i) { return weft::cw(i); }

  // Edge i of a face is opposite its vertex i, from vertex ccw(i) to vertex cw(i): seen from inside
  // the face, vertex ccw(i) is on the right.
  struct Edge {
    std::uint32_t face = kNone;
    int i = 0;
    friend bool operator==(const Edge&, const Edge&) = default;
  };

  // The poller must outlive the triangulation.
  explicit Triangulation(StopPoller& poller) : poller_(poller) {}

  // Makes the Delaunay triangulation of the points; a, b and c are three that are not on a line.
  // Coincident points share one vertex. REQUIRES: nothing was built before, and coordinates that
  // `validate` accepts.
  //
  // Expected O(n log n), by a biased random order of insertion; 0.15 s for 300,000 random points,
  // 0.27 s for a grid of 500 x 500, which needs exact decisions only (one core of 2023).
  void build(const std::vector<Point>& points, std::uint32_t a, std::uint32_t b, std::uint32_t c);

  // The squared distance between the two nearest vertices that `build` made.
  double nearest2() const { return nearest2_; }

  // The vertex of an input point.
  Vertex vertex_of(std::uint32_t point) const { return vertex_of_point_[point]; }
  // The lowest of the vertex's input points, or the id that `insert` was given.
  std::uint32_t id(Vertex v) const { return id_[v]; }

  Point at(Vertex v) const { return points_[v]; }
  std::size_t faces() const { return faces_.size(); }
  std::size_t vertices() const { return points_.size(); }
  Vertex vertex(std::uint32_t face, int i) const { return faces_[face].vertex[i]; }
  // Whether the number is in use: that of a point that coincides with another vertex is not.
  bool exists(Vertex v) const { return face_of_[v] != kNone; }
  // A face that has vertex v. REQUIRES: exists(v).
  std::uint32_t face_at(Vertex v) const { return face_of_[v]; }
  bool is_infinite(std::uint32_t face) const {
    const Vertex* const v = faces_[face].vertex;
    return v[0] == kInfinite || v[1] == kInfinite || v[2] == kInfinite;
  }
  // The index of v among the face's vertices. REQUIRES: v is one of them.
  int index(std::uint32_t face, Vertex v) const {
    const Vertex* const w = faces_[face].vertex;
    return w[0] == v ? 0 : w[1] == v ? 1 : 2;
  }
  // The same edge, from the face on its other side.
  Edge mirror(Edge e) const { return unpack(faces_[e.face].neighbor[e.i]); }
  Vertex right(Edge e) const { return faces_[e.face].vertex[ccw(e.i)]; }
  Vertex left(Edge e) const { return faces_[e.face].vertex[cw(e.i)]; }
  Vertex apex(Edge e) const { return faces_[e.face].vertex[e.i]; }

  // The edge's constraint: a number that the caller chose, or kNone.
  std::uint32_t constraint(Edge e) const { return constraints_[e.face].edge[e.i]; }
  void constrain(Edge e, std::uint32_t constraint);
  // Removes the constraint, and flips edges that are no longer Delaunay.
  void unconstrain(Edge e);

  // The edge that joins u and v, or one with face kNone. Takes as many steps as the lower of the
  // two degrees, twice.
  Edge find_edge(Vertex u, Vertex v) const;
  // Makes the edge from u to v, and returns it; constrains nothing. `first` is the first edge
  // between them, opposite u. REQUIRES: the line from u to v passes through no other vertex and
  // no constrained edge.
  Edge insert_edge(Vertex u, Vertex v, Edge first);

  enum class At { kVertex, kEdge, kFace, kOutside };
  struct Place {
    At at;
    Edge edge;  // whose apex is the vertex; the edge itself; one of the face or the infinite face
  };
  // Walks from face `start`.
  Place locate(Point p, std::uint32_t start) const;
  // Makes p a vertex with this id, and flips edges that are then not Delaunay; both halves of a
  // constrained edge keep its constraint. REQUIRES: `place` is not kVertex. In a face or outside
  // the hull, it is the place of p; at kEdge, p need not be exactly on the edge, as long as the
  // four triangles that it makes with the two faces' other edges are counter-clockwise.
  Vertex insert(Point p, std::uint32_t id, const Place& place);

 private:
  struct OnEdges {
    std::uint32_t edge[3];
  };

  static std::uint32_t pack(std::uint32_t face, int i) {
    return face << 2 | static_cast<std::uint32_t>(i);
  }
  static Edge unpack(std::uint32_t h) { return {h >> 2, static_cast<int>(h & 3)}; }

  void link(std::uint32_t f, int i, std::uint32_t half_edge) {
    faces_[f].neighbor[i] = half_edge;
    faces_[half_edge >> 2].neighbor[half_edge & 3] = pack(f, i);
  }

  std::vector<Vertex> insertion_order() const;
  void make_first_triangle(Vertex u, Vertex v, Vertex w);
  void insert_delaunay(Vertex v, std::uint32_t start);
  std::uint32_t find_conflict(Point p, std::uint32_t start, Vertex& coincident) const;
  void find_cavity(Point p, std::uint32_t first);
  void fill_cavity(Vertex v, std::uint32_t* dead, std::size_t count, const Border* border);
  bool conflicts(const Face& face, Point p) const {
    return weft::conflicts(face, points_.data(), p);
  }

  void split_face(std::uint32_t face, Vertex v);
  void split_edge(const Edge& edge, Vertex v);
  void flip(Edge e);
  void restore();
  void fix_up(Edge e, bool left_side);
  std::uint32_t new_face();

  StopPoller& poller_;
  std::vector<Face> faces_;
  std::vector<OnEdges> constraints_;     // per face, once `build` is done
  std::vector<Point> points_;            // per vertex
  std::vector<std::uint32_t> face_of_;   // per vertex, kNone if there is none
  std::vector<std::uint32_t> id_;        // per vertex
  std::vector<Vertex> vertex_of_point_;  // per input point

  double nearest2_ = 0;
  SmallCavity cavity_;
  // Kept between insertions, to reuse their memory.
  std::vector<std::uint32_t> stack_;  // half-edges
  std::vector<std::uint32_t> dead_;   // the faces of a cavity that is not small
  std::vector<Border> border_;        // of such a cavity
};

}  // namespace weft
