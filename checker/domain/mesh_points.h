// SPDX-License-Identifier: Apache-2.0
// Finds the points of the domain, and the vertices of its arrangement, in the mesh.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "checker/domain.h"
#include "checker/domain/near_features.h"
#include "checker/edges/listed_edges.h"
#include "checker/geometry/arrangement.h"
#include "checker/mesh.h"
#include "checker/report.h"

namespace weft::check {

// Finds mesh vertices by the exact coordinates of input points.
class InputPoints {
 public:
  InputPoints(const Domain& domain, const Mesh& mesh);
  // Whether an input point has these coordinates; if so, the mesh vertex that has them.
  bool has(Vec2 p) const;
  std::optional<std::uint32_t> vertex_at(Vec2 input_point) const;

 private:
  std::vector<Vec2> points_;                            // sorted, distinct
  std::vector<std::optional<std::uint32_t>> vertices_;  // for each
};

// Judges kPoints: the mesh's own list of input points, if it has one, names each vertex and each
// point at most once, with the vertex at the coordinates of the point, or, if the point may move,
// within the merging distance. REQUIRES: structure holds.
void judge_named_points(const Domain& domain, const NearFeatures& near, const Mesh& mesh,
                        Findings& findings);

// Per input point the mesh vertex that represents it: the one with its coordinates. If there is
// none and the point may move, the nearest vertex within the merging distance, preferably one at a
// lower input point, otherwise one at any input point, otherwise any vertex.
std::vector<std::optional<std::uint32_t>> images_of_points(const Domain& domain,
                                                           const NearFeatures& near,
                                                           const Mesh& mesh);

// Per vertex of the arrangement, the mesh vertex that represents it: for an input point the one
// with its coordinates, for any other the nearest end of a listed edge within the tolerance.
std::vector<std::optional<std::uint32_t>> vertices_of_arrangement(const Arrangement& arrangement,
                                                                  const InputPoints& input_points,
                                                                  const Mesh& mesh,
                                                                  const ListedEdges& listed,
                                                                  double tolerance);

}  // namespace weft::check
