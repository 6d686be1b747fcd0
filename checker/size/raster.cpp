// SPDX-License-Identifier: Apache-2.0
#include "checker/size/raster.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace weft::check {
namespace {

// The two nodes around a coordinate, and the weight of each.
struct Weighted {
  std::array<std::size_t, 2> node;
  std::array<double, 2> weight;
};

Weighted around(double steps, std::size_t count) {
  if (!(steps > 0)) return {{0, 0}, {1, 0}};
  if (steps >= static_cast<double>(count - 1)) return {{count - 1, count - 1}, {1, 0}};
  const double below = std::floor(steps);
  const auto node = static_cast<std::size_t>(below);
  return {{node, node + 1}, {below + 1 - steps, steps - below}};
}

}  // namespace

double Raster::operator()(Vec2 p) const {
  const Weighted x = around((p.x - origin.x) / dx, columns);
  const Weighted y = around((p.y - origin.y) / dy, rows);
  double sum = 0;
  for (const std::size_t j : {0, 1})
    for (const std::size_t i : {0, 1})
      sum += x.weight[i] * y.weight[j] * values[y.node[j] * columns + x.node[i]];
  return sum;
}

}  // namespace weft::check
