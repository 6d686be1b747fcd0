// SPDX-License-Identifier: Apache-2.0
#include "client/drawing/canvas.h"

#include <algorithm>
#include <cmath>

namespace weft::client {

void Extent::add(std::span<const double> coordinates) {
  for (std::size_t i = 0; i + 1 < coordinates.size(); i += 2) {
    min_x = std::min(min_x, coordinates[i]);
    max_x = std::max(max_x, coordinates[i]);
    min_y = std::min(min_y, coordinates[i + 1]);
    max_y = std::max(max_y, coordinates[i + 1]);
  }
}

Canvas::Canvas(const Extent& extent, double long_side, double margin, double x_scale)
    : x_scale_(x_scale) {
  min_x_ = extent.empty() ? 0 : extent.min_x;
  max_y_ = extent.empty() ? 0 : extent.max_y;
  const double across = extent.width() * x_scale;
  const double up = extent.height();
  const double room = long_side - 2 * margin;
  const double longest = std::max(across, up);
  scale_ = longest > 0 ? room / longest : 1;
  width_ = std::ceil(across * scale_ + 2 * margin);
  height_ = std::ceil(up * scale_ + 2 * margin);
  left_ = (width_ - across * scale_) / 2;
  top_ = (height_ - up * scale_) / 2;
}

}  // namespace weft::client
