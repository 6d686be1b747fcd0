// SPDX-License-Identifier: Apache-2.0
// How a mesh lies on a page: scaled, y upwards, with a margin.
//
// This folder has more than 25 files because each part of a drawing has its own.
#pragma once

#include <limits>
#include <span>

#include "client/base/files.h"
#include "files/formats/domain.h"

namespace weft::client {

struct PagePoint {
  double x = 0;
  double y = 0;
};

// The box of points; empty until one is added.
struct Extent {
  void add(std::span<const double> coordinates);
  bool empty() const { return max_x < min_x; }
  double width() const { return empty() ? 0 : max_x - min_x; }
  double height() const { return empty() ? 0 : max_y - min_y; }

  double min_x = std::numeric_limits<double>::infinity();
  double min_y = std::numeric_limits<double>::infinity();
  double max_x = -std::numeric_limits<double>::infinity();
  double max_y = -std::numeric_limits<double>::infinity();
};

class Canvas {
 public:
  // x is drawn `x_scale` times as long as y.
  Canvas(const Extent& extent, double long_side, double margin, double x_scale = 1);

  double width() const { return width_; }
  double height() const { return height_; }
  // Units of the page for one of y.
  double scale() const { return scale_; }
  PagePoint at(double x, double y) const {
    return {left_ + (x - min_x_) * scale_ * x_scale_, top_ + (max_y_ - y) * scale_};
  }
  PagePoint at(Point p) const { return at(p.x, p.y); }

 private:
  double x_scale_;
  double min_x_ = 0;
  double max_y_ = 0;
  double scale_ = 1;
  double left_ = 0;
  double top_ = 0;
  double width_ = 0;
  double height_ = 0;
};

}  // namespace weft::client
