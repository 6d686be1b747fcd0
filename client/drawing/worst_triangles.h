// SPDX-License-Identifier: Apache-2.0
// The triangles with the smallest angles, of those that are added.
#pragma once

#include <cstddef>
#include <vector>

#include "client/drawing/drawn_triangle.h"

namespace weft::client {

struct WorstTriangle {
  double angle_deg = 0;
  DrawnTriangle triangle;
};

class WorstTriangles {
 public:
  WorstTriangles(std::size_t most, DrawnUnit unit) : most_(most), unit_(unit) {}

  void add(const DrawnTriangle& triangle);
  // The worst first; of equal angles the lower number.
  std::vector<WorstTriangle> sorted() const;

 private:
  std::size_t most_;
  DrawnUnit unit_;
  std::vector<WorstTriangle> heap_;  // the best of them on top
};

}  // namespace weft::client
