// SPDX-License-Identifier: Apache-2.0
// A field of values on a grid, bilinear between its nodes; for half a cell beside the grid, that of
// its nearest point. Undefined (NaN) in a cell with a node that is NaN, and farther outside.
// Independent of the engine's.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "checker/domain.h"

namespace weft::check {

struct RasterField {
  Vec2 origin;  // of the first node
  double dx = 1;
  double dy = 1;
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::vector<float> values;  // by rows; that of node (i, j) is [j * columns + i]

  // Returns what is wrong with the shape: an origin or a step that is not finite, a step that is
  // not positive, another number of values than columns * rows, or none; nullopt if nothing is.
  std::optional<std::string> fault() const;

  // REQUIRES: no fault.
  double value(Vec2 p) const;
  double slope(Vec2 p) const;  // the length of the gradient

 private:
  struct Patch;
  std::optional<Patch> patch(Vec2 p) const;
};

}  // namespace weft::check
