// SPDX-License-Identifier: Apache-2.0
#include "engine/refine/triangle_block.h"

#include <algorithm>

#include "engine/base/simd.h"

namespace weft {

void TriangleBlock::find_centroids() {
  for (std::size_t i = 0; i < size; ++i) {
    centroid_x[i] = x[0][i] + ((x[1][i] - x[0][i]) + (x[2][i] - x[0][i])) * (1.0 / 3);
    centroid_y[i] = y[0][i] + ((y[1][i] - y[0][i]) + (y[2][i] - y[0][i])) * (1.0 / 3);
  }
  for (std::size_t i = size; i % 8 != 0; ++i) {
    centroid_x[i] = centroid_x[0];
    centroid_y[i] = centroid_y[0];
  }
}

Box TriangleBlock::box() const {
  Box box;
  const auto extent = [this](const double(&coordinate)[3][kSize], double& least, double& most) {
    // If the number is odd, the last one is taken twice.
    __m128d low[3];
    __m128d high[3];
    for (std::size_t k = 0; k < 3; ++k) low[k] = high[k] = _mm_set1_pd(coordinate[k][size - 1]);
    for (std::size_t i = 0; i + 1 < size; i += 2) {
      for (std::size_t k = 0; k < 3; ++k) {
        const __m128d c = _mm_load_pd(&coordinate[k][i]);
        low[k] = _mm_min_pd(low[k], c);
        high[k] = _mm_max_pd(high[k], c);
      }
    }
    const __m128d l = _mm_min_pd(_mm_min_pd(low[0], low[1]), low[2]);
    const __m128d h = _mm_max_pd(_mm_max_pd(high[0], high[1]), high[2]);
    least = std::min(l[0], l[1]);
    most = std::max(h[0], h[1]);
  };
  extent(x, box.min_x, box.max_x);
  extent(y, box.min_y, box.max_y);
  return box;
}

}  // namespace weft
