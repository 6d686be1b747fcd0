// SPDX-License-Identifier: Apache-2.0
// The limit to the growth of a size within the domain (gradation.h), where the distance of two
// points is that of the shortest path in the domain. A path along the edges of a mesh of it, or
// straight through two neighbouring triangles, is no shorter, so what the samples of the mesh give
// along such paths is nowhere below the limit. Independent of the engine's.
//
//   const GradationWithin limit(mesh, areas, 0.15);
//   double bound = limit(p, size(p));
#pragma once

#include <cstdint>
#include <vector>

#include "checker/domain.h"
#include "checker/geometry/box_tree.h"
#include "checker/mesh.h"

namespace weft::check {

class GradationWithin {
 public:
  // `areas`: the bound on areas at each vertex, then at the centroid of each triangle, squared
  // units. What is not finite, or negative, is no sample. REQUIRES: the indices of triangles are
  // vertices; gradation > 0, finite; the mesh outlives this.
  GradationWithin(const Mesh& mesh, const std::vector<double>& areas, double gradation);

  // The bound on areas at p, a point of the mesh, that the samples give, if it is below `area`;
  // else `area`.
  double operator()(Vec2 p, double area) const;

 private:
  void spread();

  const Mesh& mesh_;
  double gradation_;
  std::vector<double> edges_;  // at the vertices, then at the centroids
  BoxTree tree_;               // of the triangles
};

}  // namespace weft::check
