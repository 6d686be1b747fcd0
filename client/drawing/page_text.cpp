// SPDX-License-Identifier: Apache-2.0
#include "client/drawing/page_text.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "client/drawing/cairo_library.h"
#include "files/base/text.h"

namespace weft::client {

void set_color(cairo_t* cairo, const Color& color, double alpha) {
  loaded_cairo().cairo_set_source_rgba(cairo, color.red, color.green, color.blue, alpha);
}

void put_text(cairo_t* cairo, PagePoint at, const std::string& text, const TextStyle& style) {
  loaded_cairo().cairo_select_font_face(cairo, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                                        CAIRO_FONT_WEIGHT_NORMAL);
  loaded_cairo().cairo_set_font_size(cairo, style.height);
  double x = at.x;
  if (style.align == Align::kCentre) {
    cairo_text_extents_t extents;
    loaded_cairo().cairo_text_extents(cairo, text.c_str(), &extents);
    x -= extents.x_bearing + extents.width / 2;
  }
  loaded_cairo().cairo_move_to(cairo, x, at.y);
  if (style.halo) {
    loaded_cairo().cairo_text_path(cairo, text.c_str());
    set_color(cairo, kPaper, 0.85);
    loaded_cairo().cairo_set_line_width(cairo, style.height / 4);
    loaded_cairo().cairo_stroke(cairo);
    loaded_cairo().cairo_move_to(cairo, x, at.y);
  }
  set_color(cairo, style.color);
  loaded_cairo().cairo_show_text(cairo, text.c_str());
  loaded_cairo().cairo_new_path(cairo);
}

double text_width(const std::string& text, double height) {
  constexpr double kWidthOfALetter = 0.6;
  const auto letters =
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; });
  return static_cast<double>(letters) * kWidthOfALetter * height;
}

std::string number_text(double value) {
  const double size = std::abs(value);
  if (size >= 1000 && size < 1e6)
    return (value < 0 ? "-" : "") + with_separators(static_cast<std::uint64_t>(std::llround(size)));
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  std::string number = text;  // 1e-05
  if (const auto e = number.find('e'); e != std::string::npos) {
    if (number[e + 1] == '+') number.erase(e + 1, 1);
    const auto digits = e + 1 + (number[e + 1] == '-' ? 1 : 0);
    if (number[digits] == '0') number.erase(digits, 1);
  }
  return number;
}

}  // namespace weft::client
