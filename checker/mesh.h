// SPDX-License-Identifier: Apache-2.0
// The mesh that is judged. Nothing is assumed: indices may be out of range and coordinates NaN;
// `check` reports that.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "checker/domain.h"

namespace weft::check {

struct Mesh {
  // An edge of the mesh that lies on an input segment.
  struct Edge {
    std::uint32_t a = 0;  // index into vertices
    std::uint32_t b = 0;
    std::int32_t marker = 0;
  };

  std::vector<Vec2> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise
  std::vector<std::int32_t> regions;                    // one per triangle, or empty: all 0
  std::vector<Edge> edges;                              // each once, in either direction
  // Of each edge, the bulge of the arc from a to b that it is a chord of, 0 if it is straight; or
  // empty: not said.
  std::vector<double> bulges;
  // Mesh vertices that represent input points: (vertex, the lowest point that it represents); or
  // empty: the checker finds them by their coordinates.
  std::vector<std::array<std::uint32_t, 2>> input_points;
};

}  // namespace weft::check
