// SPDX-License-Identifier: Apache-2.0
// Where the points of the domain, and the vertices of its arrangement, are in the mesh.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "checker/domain.h"
#include "checker/domain/near_features.h"
#include "checker/geometry/arrangement.h"
#include "checker/mesh.h"
#include "checker/mesh/listed_edges.h"
#include "checker/report.h"

namespace weft::check {

// Finds mesh vertices by the exact coordinates of input points.
class InputPoints {
 public:
  InputPoints(const Domain& domain, const Mesh& mesh);
  // Whether an input point has these coordinates, and the mesh vertex that has them then.
  bool has(Vec2 p) const;
  std::optional<std::uint32_t> vertex_at(Vec2 input_point) const;

 private:
  std::vector<Vec2> points_;                            // sorted, distinct
  std::vector<std::optional<std::uint32_t>> vertices_;  // for each
};

// kPoints: the mesh's own list of input points, if it has one, names each vertex and each point at
// most once, and a vertex at the place of the point, or, if the point may move, within the merging
// distance. REQUIRES: structure holds.
void judge_named_points(const Domain& domain, const NearFeatures& near, const Mesh& mesh,
                        Findings& findings);

// Per input point the mesh vertex that stands for it: the one with its coordinates; otherwise, if
// the point may move, the nearest within the merging distance that is at the place of a lower input
// point; or else at that of any input point; or else the nearest of all.
std::vector<std::optional<std::uint32_t>> images_of_points(const Domain& domain,
                                                           const NearFeatures& near,
                                                           const Mesh& mesh);

// Per vertex of the arrangement, the mesh vertex that stands for it: for an input point the one
// with its coordinates, for any other the nearest end of a listed edge within the tolerance.
std::vector<std::optional<std::uint32_t>> vertices_of_arrangement(const Arrangement& arrangement,
                                                                  const InputPoints& input_points,
                                                                  const Mesh& mesh,
                                                                  const ListedEdges& listed,
                                                                  double tolerance);

}  // namespace weft::check
