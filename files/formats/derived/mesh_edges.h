// SPDX-License-Identifier: Apache-2.0
// The edges of a triangle mesh, each once, whatever the number of triangles at it: the sides of the
// triangles and the mesh's own edges (those on input segments).
//
// Edges are numbered by their lower vertex, then by their higher one, so the numbers depend only on
// the vertices. Side k of triangle t runs from its corner k to its corner (k + 1) % 3. Takes time
// and room linear in the triangles, 40 bytes each, in the mesh's pages. Sides have 32 bits:
// more than a third of 2^32 triangles are a std::system_error (EOVERFLOW).
//
//   const MeshEdges edges(mesh);
//   edges.of_side(3 * t + k), edges.of_input_edge(i), edges.low(e), edges.high(e)
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "files/formats/mesh.h"

namespace weft::files {

class MeshEdges {
 public:
  // REQUIRES: mesh.order is 1, vertex numbers are in range.
  explicit MeshEdges(const MeshView& mesh);

  std::size_t size() const { return size_; }
  std::uint32_t low(std::size_t e) const { return ends_[2 * e]; }
  std::uint32_t high(std::size_t e) const { return ends_[2 * e + 1]; }
  std::uint32_t of_side(std::size_t side) const { return edge_of_side_[side]; }
  std::uint32_t of_input_edge(std::size_t i) const { return edge_of_side_[sides_ + i]; }
  // Whether it is a side of exactly one triangle.
  bool on_boundary(std::size_t e) const { return triangles_at_[e] == 1; }

 private:
  std::size_t sides_ = 0;                     // of triangles
  std::size_t size_ = 0;                      // edges; the next two have room for more
  ScratchArray<std::uint32_t> ends_;          // two per edge, the lower first
  ScratchArray<std::uint8_t> triangles_at_;   // per edge: 0, 1, or 2 for more than one
  ScratchArray<std::uint32_t> edge_of_side_;  // of the triangles' sides, then of the mesh's edges
};

// The marker of every edge: that of the mesh's own edge, otherwise 0.
ScratchArray<std::int32_t> edge_markers(const MeshView& mesh, const MeshEdges& edges);

constexpr std::uint32_t kNoSide = 0xffffffff;

// Of every side of a triangle, the side of another triangle on the same edge; kNoSide if there is
// none. Of three triangles at an edge, the last has none.
ScratchArray<std::uint32_t> opposite_sides(const MeshView& mesh, const MeshEdges& edges);

// Of every edge, the first side of a triangle on it; kNoSide if there is none.
ScratchArray<std::uint32_t> first_sides(const MeshView& mesh, const MeshEdges& edges);

// The boundary of a mesh as closed rings, with the triangles on their left: counter-clockwise
// around the outside, clockwise around holes. A ring visits no vertex twice; holes that share a
// vertex are two rings.
struct BoundaryRings {
  std::vector<std::uint32_t> vertices;  // ring after ring
  std::vector<std::int32_t> markers;    // of the edge from each to the next of its ring
  std::vector<std::size_t> starts;      // of each ring in `vertices`; one more at the end

  std::size_t size() const { return starts.size() - 1; }
};

// REQUIRES: triangles are counter-clockwise and do not overlap; sides that close no ring are left
// out.
BoundaryRings boundary_rings(const MeshView& mesh, const MeshEdges& edges);

// Twice the area that the ring goes round counter-clockwise: negative around a hole.
double signed_area(const MeshView& mesh, std::span<const std::uint32_t> ring);

}  // namespace weft::files
