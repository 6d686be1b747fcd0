// SPDX-License-Identifier: Apache-2.0
// Point location by a ray: finds the edge of an arrangement nearest to the left of a point, at
// the point's height or, to avoid vertices, infinitesimally above. Exact.
#pragma once

#include <cstdint>
#include <optional>

#include "checker/domain.h"
#include "checker/geometry/arrangement.h"
#include "checker/geometry/box_tree.h"

namespace weft::check {

struct RayHit {
  std::optional<std::uint32_t> on_edge;  // an edge that the point lies on
  std::optional<std::uint32_t>
      half_edge;  // of the nearest edge, the one with the point on its left
};

// `tree` holds a box of each edge. Uses only the vertices and edges of the arrangement.
RayHit nearest_to_the_left(const Arrangement& arrangement, const BoxTree& tree, Vec2 p);

}  // namespace weft::check
