// SPDX-License-Identifier: Apache-2.0
// What stands below the mesh: a scale bar, how many triangles are seen, what the colours and the
// marks mean. Parts stand side by side as far as they fit, the others below.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "client/drawing/canvas.h"
#include "client/drawing/coloring.h"
#include "client/drawing/colors.h"
#include "files/formats/names.h"

// Of cairo.
typedef struct _cairo cairo_t;

namespace weft::client {

class Legend {
 public:
  // `em` is the height of the font, in units of the page, as are all lengths here.
  explicit Legend(double em) : em_(em) {}

  // A bar of a round length, at most `most`. `scale` is units of the page for one of the mesh, or
  // for a metre if the unit is metres or degrees.
  void add_scale_bar(double scale, double most, DrawnUnit unit);
  void add_text(const std::string& text);
  // What the colours mean; `mean`: each pixel shows the mean of its triangles; `regions`: their
  // names, as far as they have any.
  void add_colors(const Coloring& coloring, DrawnUnit unit, bool mean, const NameTable& regions);
  // A mark as put_mark puts it, and what it means.
  void add_mark(const std::string& text, const Color& color = kMarkInk);

  double least_width() const;
  double height(double width) const;
  // REQUIRES: width is at least least_width.
  void draw(cairo_t* cairo, PagePoint top_left, double width) const;

 private:
  static constexpr double kGap = 2.5;
  struct Part {
    double width = 0;
    std::function<void(cairo_t*, PagePoint top_left)> draw;
    double gap = kGap;  // behind it, in ems
  };
  void add_value_bar(const Coloring& coloring, DrawnUnit unit, bool mean);
  void add_regions(const Coloring& coloring, const NameTable& names);
  // Calls at(part, x, y) for each part, and returns the height of all.
  template <class At>
  double lay_out(double width, const At& at) const;

  double em_;
  std::vector<Part> parts_;
};

// A ring of this radius.
void put_mark(cairo_t* cairo, PagePoint at, double radius, double line_width,
              const Color& color = kMarkInk);

}  // namespace weft::client
