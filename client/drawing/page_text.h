// SPDX-License-Identifier: Apache-2.0
// Text on a page.
#pragma once

#include <string>

#include "client/drawing/canvas.h"
#include "client/drawing/colors.h"

// Of cairo.
typedef struct _cairo cairo_t;

namespace weft::client {

void set_color(cairo_t* cairo, const Color& color, double alpha = 1);

enum class Align { kLeft, kCentre };

// `at` is on the baseline; `height` is of the font. A halo of paper lifts text off what is below.
struct TextStyle {
  double height = 10;
  Align align = Align::kLeft;
  bool halo = false;
  Color color = kBoundaryInk;
};
void put_text(cairo_t* cairo, PagePoint at, const std::string& text, const TextStyle& style);

// About as wide as it is drawn, rather more; needs no font.
double text_width(const std::string& text, double height);

// A number in three digits: "0.05", "12,500", "2e-7".
std::string number_text(double value);

}  // namespace weft::client
