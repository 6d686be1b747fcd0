// SPDX-License-Identifier: Apache-2.0
// Triangles that are measured together, two at a time, as arrays of coordinates: for the statistics
// of a mesh (emit/quality_statistics.h) and for the samples of a coarse one
// (parallel/coarse_phase.h). A value of its thread.
#pragma once

#include <cstddef>

#include "engine/base/geometry.h"

namespace weft {

// Corners of up to kSize triangles, as arrays.
struct TriangleBlock {
  static constexpr std::size_t kSize = 256;  // a multiple of SizeFunction::kLanes

  std::size_t size = 0;
  alignas(64) double x[3][kSize];
  alignas(64) double y[3][kSize];
  alignas(64) double centroid_x[kSize];
  alignas(64) double centroid_y[kSize];
  alignas(64) double bound[kSize];  // upper bound on the area; infinity is none
  bool on_lattice[kSize];           // whether there is a lattice at the centroid

  void add(Point a, Point b, Point c) {
    const Point corner[3] = {a, b, c};
    for (std::size_t i = 0; i < 3; ++i) {
      x[i][size] = corner[i].x;
      y[i][size] = corner[i].y;
    }
    ++size;
  }
  // Computes the centroids, also of the lanes up to the next multiple of SizeFunction::kLanes.
  void find_centroids();
  // REQUIRES: there is a triangle.
  Box box() const;
};

}  // namespace weft
