// SPDX-License-Identifier: GPL-3.0-or-later
// A constrained Delaunay triangulation in plain arrays: 24 bytes a face, and 12 for what lies on
// its edges. The plane outside the convex hull is covered by faces with the vertex kInfinite.
//
// Where four points lie on one circle, the diagonal is the one of CGAL's symbolic perturbation
// (Devillers, Teillaud, "Perturbations and vertex removal in a 3D Delaunay triangulation", 2003):
// so the triangulation depends on the points alone, not on their order.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/domain/filtered.h"
#include "engine/domain/pacer.h"
#include "engine/geometry.h"

namespace weft {

class Triangulation {
 public:
  using Vertex = std::uint32_t;
  static constexpr Vertex kInfinite = kNone;

  static constexpr int ccw(int i) { return i == 2 ? 0 : i + 1; }
  static constexpr int cw(int i) { return i == 0 ? 2 : i - 1; }

  // Edge i of a face is opposite its vertex i, from vertex ccw(i) to vertex cw(i): going across it
  // out of the face, the first is on the right.
  struct Edge {
    std::uint32_t face = kNone;
    int i = 0;
    friend bool operator==(const Edge&, const Edge&) = default;
  };

  explicit Triangulation(Pacer& pacer) : pacer_(pacer) {}

  // The Delaunay triangulation of the points, which are not all on a line; a, b and c are three
  // that are not. Of coincident points one becomes the vertex.
  void build(const std::vector<Point>& points, std::uint32_t a, std::uint32_t b, std::uint32_t c);

  // The vertex of an input point.
  Vertex vertex_of(std::uint32_t point) const { return vertex_of_point_[point]; }
  // The lowest of the vertex's input points, or points.size() + k of the k-th other vertex.
  std::uint32_t id(Vertex v) const { return id_[v]; }

  Point at(Vertex v) const { return points_[v]; }
  std::size_t faces() const { return faces_.size(); }
  std::size_t vertices() const { return points_.size(); }
  Vertex vertex(std::uint32_t face, int i) const { return faces_[face].vertex[i]; }
  bool exists(Vertex v) const { return face_of_[v] != kNone; }
  std::uint32_t face_at(Vertex v) const { return face_of_[v]; }
  bool is_infinite(std::uint32_t face) const {
    const Vertex* const v = faces_[face].vertex;
    return v[0] == kInfinite || v[1] == kInfinite || v[2] == kInfinite;
  }
  int index(std::uint32_t face, Vertex v) const {
    const Vertex* const w = faces_[face].vertex;
    return w[0] == v ? 0 : w[1] == v ? 1 : 2;
  }
  Edge mirror(Edge e) const { return unpack(faces_[e.face].neighbor[e.i]); }
  Vertex right(Edge e) const { return faces_[e.face].vertex[ccw(e.i)]; }
  Vertex left(Edge e) const { return faces_[e.face].vertex[cw(e.i)]; }
  Vertex apex(Edge e) const { return faces_[e.face].vertex[e.i]; }
  // kNone where there is none.
  std::uint32_t constraint(Edge e) const { return constraints_[e.face].edge[e.i]; }
  void constrain(Edge e, std::uint32_t constraint);
  // An edge that joins u and v, face kNone where there is none.
  Edge find_edge(Vertex u, Vertex v) const;

  // Forgets what lies on the edge.
  void unconstrain(Edge e);
  // Makes the edge from u to v, where only edges without constraints lie between; `first` is the
  // first of them, opposite to u.
  Edge insert_edge(Vertex u, Vertex v, Edge first);

  enum class At { kVertex, kEdge, kFace, kOutside };
  struct Place {
    At at;
    Edge edge;  // its apex is the vertex, it is the edge, or of the face
  };
  Place locate(Point p, std::uint32_t start) const;
  // A new vertex; both halves of a constrained edge keep its constraint.
  Vertex insert(Point p, std::uint32_t id, const Place& place);

 private:
  struct Face {
    Vertex vertex[3];
    std::uint32_t neighbor[3];  // half-edges: face << 2 | edge
  };
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
  bool conflicts(const Face& face, Point p) const;
  int perturbed(Point a, Point b, Point c, Point p) const;
  void insert_delaunay(Vertex v, std::uint32_t start);
  std::uint32_t find_conflict(Point p, std::uint32_t start, Vertex& coincident) const;
  void flip(Edge e);
  void restore(std::vector<std::uint32_t>& suspects);
  void fix_up(Edge e, bool left_side);
  std::uint32_t new_face();

  Pacer& pacer_;
  std::vector<Face> faces_;
  std::vector<OnEdges> constraints_;
  std::vector<Point> points_;            // per vertex
  std::vector<std::uint32_t> face_of_;   // per vertex: a face that has it, kNone for duplicates
  std::vector<std::uint32_t> id_;        // per vertex
  std::vector<Vertex> vertex_of_point_;  // per input point
  // Of insert_delaunay.
  struct Border {
    Vertex from;
    std::uint32_t outside;
  };
  std::vector<std::uint32_t> stack_;
  std::vector<std::uint32_t> dead_;
  std::vector<Border> border_;
};

}  // namespace weft
