// SPDX-License-Identifier: Apache-2.0
// The Voronoi cells of a mesh's vertices, clipped by the domain: a cell for each vertex of a
// triangle, of the places that are nearer to it than to any other vertex.
//
// The corners of a cell are the centres of the circumcircles of the triangles around its vertex; of
// a vertex on the boundary also the vertex, and the middles of its two sides. A centre beyond the
// boundary, of a triangle that is obtuse there, is replaced by the places where the edges of the
// cells cross the boundary. Edges inside the domain that are not Delaunay, as those on segments may
// be, are flipped first, so that the line between two neighbours is perpendicular to what their
// cells have in common.
//
// Laws: the cells cover the domain and do not overlap; cells that touch along an edge share its two
// corners. Both need the boundary's sides to be sides of Delaunay triangles of the domain, as in
// every mesh that weft makes.
//
// Takes 80 bytes for each triangle, in the mesh's pages.
//
//   const VoronoiCells cells(mesh);
//   cells.corner_count(), cells.each_corner([](Point at) { ... });
//   cells.each_cell([](std::uint32_t vertex, std::span<const std::uint32_t> corners) { ... });
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <vector>

#include "files/formats/derived/mesh_edges.h"
#include "files/formats/domain.h"
#include "files/formats/mesh.h"

namespace weft::files {

class VoronoiCells {
 public:
  // REQUIRES: the view outlives the cells; mesh.order is 1, vertex numbers are in range, triangles
  // are counter-clockwise.
  explicit VoronoiCells(const MeshView& mesh);

  std::size_t cell_count() const { return cells_; }
  std::size_t corner_count() const { return corners_; }
  // In the order of their numbers, from 0.
  void each_corner(const std::function<void(Point)>& act) const;
  // In the order of the vertices. Corners are clockwise.
  void each_cell(const std::function<void(std::uint32_t vertex,
                                          std::span<const std::uint32_t> corners)>& act) const;

 private:
  static constexpr std::uint32_t kNone = kNoSide;

  // Side k of triangle t has the number 3 t + k and runs from corner k to corner (k + 1) % 3.
  static std::uint32_t next(std::uint32_t side) { return side % 3 == 2 ? side - 2 : side + 1; }
  static std::uint32_t previous(std::uint32_t side) { return side % 3 == 0 ? side + 2 : side - 1; }
  Point point(std::uint32_t vertex) const {
    return {mesh_.coordinates[2 * std::size_t{vertex}],
            mesh_.coordinates[2 * std::size_t{vertex} + 1]};
  }
  Point from(std::uint32_t side) const { return point(corner_[side]); }
  Point to(std::uint32_t side) const { return point(corner_[next(side)]); }
  Point middle(std::uint32_t side) const;
  double length(std::uint32_t side) const;
  bool on_boundary(std::uint32_t side) const { return across_[side] == kNone; }

  // Whether the triangles at the side are not Delaunay. REQUIRES: it has two.
  bool must_flip(std::uint32_t side) const;
  void flip(std::uint32_t side);
  void make_delaunay();
  Point circumcentre(std::uint32_t triangle) const;
  // The boundary's side through which the way from the triangle to its circumcentre leaves the
  // domain; kNone if it does not.
  std::uint32_t way_out(std::uint32_t triangle) const;
  void merge_centres();
  // The triangle that stands for all that have its circumcentre.
  std::uint32_t of_centre(std::uint32_t triangle) const;
  void number_corners();
  void find_fans();

  // The cell's edge that is perpendicular to a side: where it ends, in the triangle of the side and
  // across.
  struct End {
    Point at;
    std::uint32_t beyond;  // the side of the boundary that it is beyond; kNone: inside
  };
  End near_end(std::uint32_t side) const;
  End far_end(std::uint32_t side) const;
  bool has_middle(std::uint32_t side) const;
  bool crosses(std::uint32_t side) const;
  Point crossing(std::uint32_t side) const;
  void add_fan(std::uint32_t side, std::vector<std::uint32_t>& corners) const;

  MeshView mesh_;
  ScratchArray<std::uint32_t> corner_;  // of each side, the vertex that it runs from
  ScratchArray<std::uint32_t> across_;  // of each side, the same side of the other triangle
  ScratchArray<std::uint32_t> same_;    // of each triangle, one with the same centre, or itself
  ScratchArray<std::uint32_t> beyond_;  // of each triangle, its way out
  ScratchArray<std::uint32_t> fan_;     // of each vertex, the first side from it, clockwise
  std::multimap<std::uint32_t, std::uint32_t> more_fans_;  // of vertices where holes touch
  ScratchArray<std::uint32_t> of_triangle_;                // numbers of corners; kNone: none there
  ScratchArray<std::uint32_t> of_side_;
  ScratchArray<std::uint32_t> of_vertex_;
  ScratchArray<std::uint32_t> of_middle_;  // of sides on the boundary
  std::size_t cells_ = 0;
  std::size_t corners_ = 0;
};

}  // namespace weft::files
