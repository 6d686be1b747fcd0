// SPDX-License-Identifier: Apache-2.0
// The grading function as values at the nodes of a grid, bilinear between them; outside the grid,
// that of the nearest point of the grid. Independent of the engine's.
#pragma once

#include <cstddef>
#include <vector>

#include "checker/domain.h"

namespace weft::check {

// REQUIRES: dx and dy are positive; columns * rows values, at least one.
struct Raster {
  Vec2 origin;  // of the first node
  double dx = 1;
  double dy = 1;
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::vector<double> values;  // by rows; that of node (i, j) is [j * columns + i]

  // Squared units. Agrees with the engine's to rounding.
  double operator()(Vec2 p) const;
};

}  // namespace weft::check
