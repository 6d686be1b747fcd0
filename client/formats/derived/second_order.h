// SPDX-License-Identifier: Apache-2.0
// The same mesh with six-node triangles and three-node edges: a node in the middle of every side,
// shared by the triangles at it. Sides stay straight.
//
// Nodes are the vertices, with the numbers that they have, then the midside nodes in the order of
// MeshEdges. A triangle has its corners 0, 1, 2, then the nodes between 0 and 1, 1 and 2, 2 and 0,
// as VTK and Gmsh require; an edge has its ends, then its middle. A midside node has the mean of
// the values at the ends of its side. Takes 56 bytes per triangle in the mesh's pages, and 40 more
// for a while. Nodes have 32 bits: more are a std::system_error (EOVERFLOW).
#pragma once

#include <cstdint>
#include <vector>

#include "client/formats/mesh.h"

namespace weft::client {

class SecondOrderMesh {
 public:
  // `mesh`, of order 1, must outlive this.
  explicit SecondOrderMesh(const MeshView& mesh);
  // Of order 2.
  MeshView view() const;

 private:
  MeshView mesh_;
  ScratchArray<double> coordinates_;
  ScratchArray<std::uint32_t> triangles_;  // six nodes each
  ScratchArray<std::uint32_t> edges_;      // three nodes each
  std::vector<ScratchArray<double>> arrays_;
  std::vector<VertexValues> vertex_values_;  // of arrays_
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

}  // namespace weft::client
