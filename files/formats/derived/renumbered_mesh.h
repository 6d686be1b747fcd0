// SPDX-License-Identifier: Apache-2.0
// The same mesh with its vertices in the order of reverse Cuthill-McKee (George and Liu, Computer
// Solution of Large Sparse Positive Definite Systems, 1981, chapter 4), which brings the vertices
// of an edge close to each other: matrices of finite elements get a small bandwidth. Triangles and
// edges keep their order.
//
// Every component is numbered from a vertex at its rim, the components by their least vertex. The
// result depends on the triangles alone. Takes some 90 bytes of memory per triangle, the whole mesh
// among them, whatever the mesh's pages.
#pragma once

#include <cstdint>
#include <vector>

#include "files/formats/mesh.h"

namespace weft::files {

class RenumberedMesh {
 public:
  // `mesh` must outlive this. REQUIRES: it is of order 1.
  explicit RenumberedMesh(const MeshView& mesh);
  MeshView view() const;

  // The greatest distance of the numbers of two vertices at an edge.
  std::uint32_t bandwidth_before() const { return before_; }
  std::uint32_t bandwidth() const { return after_; }

 private:
  MeshView mesh_;
  std::vector<double> coordinates_;
  std::vector<std::uint32_t> triangles_;
  std::vector<std::uint32_t> edges_;
  std::vector<std::uint32_t> input_points_;
  std::vector<std::vector<double>> arrays_;
  std::vector<VertexValues> vertex_values_;  // of arrays_
  std::uint32_t before_ = 0;
  std::uint32_t after_ = 0;
};

}  // namespace weft::files
