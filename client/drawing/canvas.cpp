// SPDX-License-Identifier: Apache-2.0
#include "client/drawing/canvas.h"

#include <algorithm>
#include <cmath>

namespace weft::client {

Canvas::Canvas(const MeshView& mesh, double long_side, double margin) {
  double max_x = 0;
  double min_y = 0;
  for (std::size_t i = 0; i + 1 < mesh.coordinates.size(); i += 2) {
    const double x = mesh.coordinates[i];
    const double y = mesh.coordinates[i + 1];
    min_x_ = i == 0 ? x : std::min(min_x_, x);
    max_x = i == 0 ? x : std::max(max_x, x);
    min_y = i == 0 ? y : std::min(min_y, y);
    max_y_ = i == 0 ? y : std::max(max_y_, y);
  }
  const double room = long_side - 2 * margin;
  const double extent = std::max(max_x - min_x_, max_y_ - min_y);
  scale_ = extent > 0 ? room / extent : 1;
  width_ = std::ceil((max_x - min_x_) * scale_ + 2 * margin);
  height_ = std::ceil((max_y_ - min_y) * scale_ + 2 * margin);
  left_ = (width_ - (max_x - min_x_) * scale_) / 2;
  top_ = (height_ - (max_y_ - min_y) * scale_) / 2;
}

}  // namespace weft::client
