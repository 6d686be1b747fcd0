// SPDX-License-Identifier: Apache-2.0
// Draws a mesh whose triangles are about as small as pixels, piece by piece. Each pixel takes
// the mean colour of the triangles in it; each edge leaves ink along its length, and a pixel with
// ink i is covered to the fraction 1 - exp(-i), so that edges blend to grey and dense parts get
// darker without clogging. The width of the lines depends on the length of all edges, so it is
// applied at the end. Takes 4 bytes per pixel, and 16 more if triangles are coloured.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "client/drawing/canvas.h"
#include "client/drawing/coloring.h"
#include "client/drawing/colors.h"
#include "client/formats/mesh.h"

namespace weft::client {

// Pixels as cairo's RGB24: 0x00RRGGBB, rows from the top.
struct Image {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<std::uint32_t> pixels;
};

class DenseImage {
 public:
  // `coloring` must outlive it.
  DenseImage(const Canvas& canvas, const Coloring& coloring);

  // Adds the triangles of a piece, with all the vertices that they refer to. All triangles together
  // must name each edge between two of them once in each direction.
  void add(const MeshView& piece);
  // Mean length of the edges between two triangles, in pixels.
  double mean_edge() const;
  Image image() const;

 private:
  // Sums of the colours in a pixel, and how many.
  struct Paint {
    float red = 0;
    float green = 0;
    float blue = 0;
    float weight = 0;

    void add(const Color& color, float amount);
  };
  void fill(const PagePoint (&corners)[3], const Color& color);
  void stroke(PagePoint a, PagePoint b);
  void drop(double x, double y, float amount);

  const Canvas canvas_;
  const Coloring& coloring_;
  const std::size_t width_;
  const std::size_t height_;
  std::vector<float> ink_;  // of lines as wide as a pixel
  std::vector<Paint> paint_;
  double length_ = 0;
  std::size_t edges_ = 0;
};

}  // namespace weft::client
