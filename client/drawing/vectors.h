// SPDX-License-Identifier: Apache-2.0
// Draws triangles and edges as vectors. What lies outside the canvas is cut off.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "client/drawing/canvas.h"
#include "client/drawing/clip.h"
#include "client/drawing/coloring.h"
#include "client/drawing/colors.h"
#include "client/drawing/drawn_triangle.h"
#include "client/drawing/labels.h"

// Of cairo.
typedef struct _cairo cairo_t;

namespace weft::client {

class Vectors {
 public:
  // `pixel` is the unit of the widths of lines, in units of the page.
  Vectors(cairo_t* cairo, const Canvas& canvas, double pixel);

  // REQUIRES: the triangles were noted.
  void fill(std::span<const DrawnTriangle> triangles, const Coloring& coloring);
  // The edges between two triangles. Short ones are thinner, so that fine parts of a mesh are not
  // black; over colours all are fainter.
  void stroke_inner_edges(std::span<const DrawnTriangle> triangles, bool over_colors);
  // The edges of only one triangle.
  void stroke_outline(std::span<const DrawnTriangle> triangles, double pixels);
  void stroke_edges(std::span<const DrawnEdge> edges, double pixels);
  // Min x, min y, max x, max y of each, in the unit of the mesh.
  void stroke_boxes(std::span<const double> boxes, double pixels);

 private:
  struct Line {
    PagePoint a;
    PagePoint b;
  };
  void stroke(std::span<const Line> lines, const Color& color, double alpha, double width);
  void fill_one_color(std::span<const DrawnTriangle> triangles, std::span<const std::uint32_t> some,
                      const Color& color);

  cairo_t* cairo_;
  const Canvas& canvas_;
  double pixel_;
  PageBox box_;
};

// Mean length of the edges between two triangles, on the page; 0 if there are none.
double mean_inner_edge(std::span<const DrawnTriangle> triangles, const Canvas& canvas);

// Notes the values or regions of all.
void note_all(std::span<const DrawnTriangle> triangles, const Canvas& canvas, Coloring& coloring);

}  // namespace weft::client
