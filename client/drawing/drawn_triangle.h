// SPDX-License-Identifier: Apache-2.0
// A triangle as a drawing has it, and what colours and marks measure of it.
#pragma once

#include <array>
#include <cstdint>

#include "client/base/files.h"
#include "client/drawing/draw_options.h"
#include "files/formats/domain.h"

namespace weft::client {

struct DrawnTriangle {
  std::array<Point, 3> corners;  // counter-clockwise, in the unit of the mesh
  std::array<std::uint32_t, 3> vertices{};
  std::uint64_t id = 0;  // its number in the mesh
  std::int32_t region = 0;
};

Point centroid(const DrawnTriangle& triangle);

// Square units of the mesh; square metres if the unit is metres or degrees.
double area(const DrawnTriangle& triangle, DrawnUnit unit);

// 0 to 60 degrees, on the ground if the unit is degrees; 0 if the triangle is degenerate.
double smallest_angle_deg(const DrawnTriangle& triangle, DrawnUnit unit);

}  // namespace weft::client
