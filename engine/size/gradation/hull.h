// SPDX-License-Identifier: Apache-2.0
// The convex hull of points, for the question which boxes lie outside of it.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/base/geometry.h"

namespace weft {

// Half-planes that hold all points: those of the longest sides of their convex hull, which is found
// by A. M. Andrew's "Another efficient algorithm for convex hulls in two dimensions" (1979).
class Hull {
 public:
  // REQUIRES: a point.
  explicit Hull(std::vector<Point> points);
  // Whether the box lies beyond one of the sides; false for some boxes that lie outside.
  bool misses(const Box& box) const;

 private:
  static constexpr std::size_t kMaxSides = 64;

  struct Side {
    Point normal;  // of length 1, outwards
    double reach;  // of the points along it
  };
  std::vector<Side> sides_;
};

}  // namespace weft
