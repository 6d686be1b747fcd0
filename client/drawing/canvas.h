// SPDX-License-Identifier: Apache-2.0
// How a mesh lies on a page: uniformly scaled, y upwards, with a margin.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "client/formats/mesh.h"

namespace weft::client {

struct PagePoint {
  double x = 0;
  double y = 0;
};

// The box of points; empty until one is added.
struct Extent {
  void add(std::span<const double> coordinates);

  double min_x = std::numeric_limits<double>::infinity();
  double min_y = std::numeric_limits<double>::infinity();
  double max_x = -std::numeric_limits<double>::infinity();
  double max_y = -std::numeric_limits<double>::infinity();
};

class Canvas {
 public:
  Canvas(const Extent& extent, double long_side, double margin);

  double width() const { return width_; }
  double height() const { return height_; }
  PagePoint at(double x, double y) const {
    return {left_ + (x - min_x_) * scale_, top_ + (max_y_ - y) * scale_};
  }
  PagePoint vertex(const MeshView& mesh, std::uint32_t v) const {
    return at(mesh.coordinates[2 * std::size_t{v}], mesh.coordinates[2 * std::size_t{v} + 1]);
  }

 private:
  double min_x_ = 0;
  double max_y_ = 0;
  double scale_ = 1;
  double left_ = 0;
  double top_ = 0;
  double width_ = 0;
  double height_ = 0;
};

// Calls edge(a, b) once for each edge between two triangles. (Counter-clockwise triangles name such
// an edge once in each direction; edges of only one triangle may be left out.)
template <class Edge>
void for_each_inner_edge(const MeshView& mesh, Edge&& edge) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::uint32_t a = mesh.triangles[i];
    const std::uint32_t b = mesh.triangles[i % 3 == 2 ? i - 2 : i + 1];
    if (a < b) edge(a, b);
  }
}

}  // namespace weft::client
