// SPDX-License-Identifier: Apache-2.0
// The figures that sum up a mesh. All commands that print JSON name them alike.
#pragma once

#include <cstdint>

#include "client/report/json_line.h"

namespace weft::client {

struct MeshFigures {
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
  std::uint64_t edges = 0;  // on input segments
  double area = 0;
  double min_angle_deg = 0;
  double max_angle_deg = 0;
  double min_angle_p1_deg = 0;  // 1 % of the triangles have a smaller smallest angle
  double mean_quality = 0;      // of 4 sqrt(3) area / (sum of the squared edges)
  // The number of triangles with a bound on their area, over the sum of their areas over their
  // bounds: how many times the least number there are. 0: no triangle has a bound.
  double ideal_ratio = 0;
};

Json figures_json(const MeshFigures& figures);

}  // namespace weft::client
