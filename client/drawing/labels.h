// SPDX-License-Identifier: Apache-2.0
// Numbers on a drawing: markers other than 0 on edges, numbers of vertices and triangles, each
// where it fits without touching another. All count from 0.
#pragma once

#include <cstdint>
#include <span>

#include "client/drawing/canvas.h"
#include "client/drawing/drawn_triangle.h"

// Of cairo.
typedef struct _cairo cairo_t;

namespace weft::client {

// An edge on an input segment.
struct DrawnEdge {
  Point a;
  Point b;
  std::int32_t marker = 0;
};

// `height` is of the font, in units of the page.
void put_labels(cairo_t* cairo, const Canvas& canvas, std::span<const DrawnTriangle> triangles,
                std::span<const DrawnEdge> edges, double height);

}  // namespace weft::client
