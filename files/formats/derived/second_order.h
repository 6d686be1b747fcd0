// SPDX-License-Identifier: Apache-2.0
// The same mesh with six-node triangles and three-node edges: a node in the middle of every side,
// shared by the triangles at it. On an edge that is a chord of an arc it is the middle of the arc;
// all other sides are straight.
//
// A triangle must not turn over: the determinant of its Jacobian is a quadratic polynomial, and is
// above 0 everywhere if its six coefficients in Bernstein's basis are (Johnen, Remacle and Geuzaine
// 2013). Arcs that would make one of them 0 or less are straight here, too. Angles of at least 20
// degrees at an arc of 40, or 28.2 at one of 60, rule it out: tan(angle) > 2 tan(turn / 4).
//
// Nodes are the vertices, with the numbers that they have, then the midside nodes in the order of
// MeshEdges. A triangle has its corners 0, 1, 2, then the nodes between 0 and 1, 1 and 2, 2 and 0,
// as VTK and Gmsh require; an edge has its ends, then its middle. A midside node has the mean of
// the values at the ends of its side. Takes 56 bytes per triangle in the mesh's pages, and 40 more
// for a while. Nodes have 32 bits: more are a std::system_error (EOVERFLOW).
#pragma once

#include <cstdint>
#include <vector>

#include "files/formats/derived/mesh_edges.h"
#include "files/formats/mesh.h"

namespace weft::files {

class SecondOrderMesh {
 public:
  // `mesh`, of order 1, must outlive this.
  explicit SecondOrderMesh(const MeshView& mesh);
  // Of order 2.
  MeshView view() const;

  // How many edges on arcs are straight so that no triangle turns over.
  std::size_t straightened() const { return straightened_; }

 private:
  void bend(const MeshEdges& edges);
  bool turns_over(std::size_t t) const;

  MeshView mesh_;
  ScratchArray<double> coordinates_;
  ScratchArray<std::uint32_t> triangles_;  // six nodes each
  ScratchArray<std::uint32_t> edges_;      // three nodes each
  std::vector<ScratchArray<double>> arrays_;
  std::vector<VertexValues> vertex_values_;  // of arrays_
  std::size_t straightened_ = 0;
};

// The same mesh with the corners of its triangles and the ends of its edges alone, on the same
// nodes: of order 1, for what looks at sides. Takes 12 bytes per triangle in the mesh's pages if
// the mesh is of order 2.
class CornerMesh {
 public:
  // `mesh` must outlive this.
  explicit CornerMesh(const MeshView& mesh);
  const MeshView& view() const { return view_; }

 private:
  ScratchArray<std::uint32_t> triangles_;
  ScratchArray<std::uint32_t> edges_;
  MeshView view_;
};

}  // namespace weft::files
