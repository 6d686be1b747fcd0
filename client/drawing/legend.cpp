// SPDX-License-Identifier: Apache-2.0
#include "client/drawing/legend.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "client/drawing/cairo_library.h"
#include "client/drawing/page_text.h"

namespace weft::client {
namespace {

// In ems.
constexpr double kAbove = 0.5;  // the first row
constexpr double kRow = 3;
constexpr double kBarTop = 0.3;
constexpr double kBarHeight = 0.9;
constexpr double kBaseline = 1.1;  // of text beside a bar
constexpr double kBelow = 2.25;    // baseline of text below a bar
constexpr double kSmall = 0.82;    // height of that text
constexpr double kValueBarWidth = 18;
constexpr std::size_t kMaxSwatches = 24;

// At most so many characters of a name.
std::string abbreviated(const std::string& name) {
  constexpr std::size_t kMax = 32;
  std::size_t characters = 0;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool begins = (static_cast<unsigned char>(name[i]) & 0xC0) != 0x80;  // of UTF-8
    if (begins && ++characters > kMax) return name.substr(0, i) + "\u2026";
  }
  return name;
}

struct Tick {
  double value = 0;  // in the unit that Coloring uses
  std::string text;
};

// The largest of 1, 2, 5, 10, ... that does not exceed `most`.
double round_below(double most) {
  const double power = std::pow(10, std::floor(std::log10(most)));
  for (const double digit : {5.0, 2.0})
    if (digit * power <= most) return digit * power;
  return power;
}

std::vector<Tick> angle_ticks() {
  std::vector<Tick> ticks;
  for (int angle = 0; angle <= 60; angle += 10)
    ticks.push_back({static_cast<double>(angle), std::to_string(angle) + "\u00b0"});
  return ticks;
}

// From 0 up to 1 or 2, beyond which colours do not change.
std::vector<Tick> bound_ticks(const ValueRange& range) {
  constexpr int kSteps = 4;
  std::vector<Tick> ticks;
  for (int i = 0; i <= kSteps; ++i) {
    const double value = range.high * i / kSteps;
    ticks.push_back({value, number_text(value)});
  }
  if (range.high > 1) ticks.back().text += " and up";
  return ticks;
}

// 1, 10, ... or, if these are few, 1, 2, 5, 10, ...; the range is of binary logarithms.
std::vector<Tick> size_ticks(const ValueRange& range, double unit) {
  const auto in_range = [&](const std::vector<double>& digits) {
    std::vector<Tick> ticks;
    const double to_decimal = std::log10(2.0);
    const auto first = static_cast<int>(std::floor(range.low * to_decimal - std::log10(unit))) - 1;
    const auto last = static_cast<int>(std::ceil(range.high * to_decimal - std::log10(unit)));
    for (int power = first; power <= last; ++power)
      for (const double digit : digits) {
        const double size = digit * std::pow(10, power);
        const double value = std::log2(size) + std::log2(unit);
        if (value >= range.low && value <= range.high) ticks.push_back({value, number_text(size)});
      }
    return ticks;
  };
  constexpr std::size_t kFew = 3;
  constexpr std::size_t kMany = 7;
  std::vector<Tick> ticks = in_range({1});
  if (ticks.size() < kFew) ticks = in_range({1, 2, 5});
  if (ticks.size() < 2)
    ticks = {{range.low, number_text(std::exp2(range.low) / unit)},
             {range.high, number_text(std::exp2(range.high) / unit)}};
  if (const std::size_t step = ticks.size() / kMany + 1; step > 1) {
    std::vector<Tick> some;
    for (std::size_t i = 0; i < ticks.size(); i += step) some.push_back(ticks[i]);
    return some;
  }
  return ticks;
}

}  // namespace

void put_mark(cairo_t* cairo, PagePoint at, double radius, double line_width, const Color& color) {
  loaded_cairo().cairo_new_sub_path(cairo);
  loaded_cairo().cairo_arc(cairo, at.x, at.y, radius, 0, 2 * std::numbers::pi);
  set_color(cairo, kPaper, 0.8);
  loaded_cairo().cairo_set_line_width(cairo, 2.4 * line_width);
  loaded_cairo().cairo_stroke_preserve(cairo);
  set_color(cairo, color);
  loaded_cairo().cairo_set_line_width(cairo, line_width);
  loaded_cairo().cairo_stroke(cairo);
}

void Legend::add_scale_bar(double scale, double most, DrawnUnit unit) {
  if (!(std::isfinite(scale) && scale > 0 && std::isfinite(most / scale))) return;
  const double length = round_below(most / scale);
  if (!(length > 0)) return;
  const double bar = length * scale;
  std::string text = number_text(length);
  if (unit != DrawnUnit::kNone)
    text = length >= 1000 ? number_text(length / 1000) + " km" : number_text(length) + " m";
  const double width = std::max(bar, text_width(text, em_ * kSmall));
  parts_.push_back({width, [=, em = em_](cairo_t* cairo, PagePoint at) {
                      const double left = at.x + (width - bar) / 2;
                      const double bottom = at.y + em * (kBarTop + kBarHeight);
                      const double tooth = em * 0.35;
                      loaded_cairo().cairo_move_to(cairo, left, bottom - tooth);
                      loaded_cairo().cairo_line_to(cairo, left, bottom);
                      loaded_cairo().cairo_line_to(cairo, left + bar, bottom);
                      loaded_cairo().cairo_line_to(cairo, left + bar, bottom - tooth);
                      set_color(cairo, kBoundaryInk);
                      loaded_cairo().cairo_set_line_width(cairo, em * 0.1);
                      loaded_cairo().cairo_stroke(cairo);
                      put_text(cairo, {left + bar / 2, at.y + em * kBelow}, text,
                               {.height = em * kSmall, .align = Align::kCentre});
                    }});
}

void Legend::add_text(const std::string& text) {
  parts_.push_back({text_width(text, em_), [text, em = em_](cairo_t* cairo, PagePoint at) {
                      put_text(cairo, {at.x, at.y + em * kBaseline}, text, {.height = em});
                    }});
}

void Legend::add_mark(const std::string& text, const Color& color) {
  const double indent = 1.6 * em_;
  parts_.push_back(
      {indent + text_width(text, em_),
       [text, color, indent, em = em_](cairo_t* cairo, PagePoint at) {
         put_mark(cairo, {at.x + 0.6 * em, at.y + em * 0.75}, 0.5 * em, em * 0.1, color);
         put_text(cairo, {at.x + indent, at.y + em * kBaseline}, text, {.height = em});
       }});
}

void Legend::add_value_bar(const Coloring& coloring, DrawnUnit unit, bool mean) {
  const ValueRange range = coloring.range();
  std::string title = "smallest angle";
  std::vector<Tick> ticks;
  if (coloring.by() == DrawColor::kAngle) {
    ticks = angle_ticks();
  } else if (coloring.by() == DrawColor::kBound) {
    title = "area over its bound";
    ticks = bound_ticks(range);
  } else {
    constexpr double kSquareKilometre = 1e6;
    const bool kilometres = unit != DrawnUnit::kNone && std::exp2(range.high) >= kSquareKilometre;
    title = "area";
    if (unit != DrawnUnit::kNone) title += kilometres ? " in km\u00b2" : " in m\u00b2";
    ticks = size_ticks(range, kilometres ? kSquareKilometre : 1);
  }
  if (mean) title = "mean " + title;
  const double indent = text_width(title, em_) + em_;
  const double width = kValueBarWidth * em_;
  const double overhang = 2 * em_;  // of the last number
  parts_.push_back(
      {indent + width + overhang, [=, em = em_](cairo_t* cairo, PagePoint at) {
         const double left = at.x + indent;
         const double top = at.y + em * kBarTop;
         put_text(cairo, {at.x, at.y + em * kBaseline}, title, {.height = em});
         cairo_pattern_t* const colors =
             loaded_cairo().cairo_pattern_create_linear(left, 0, left + width, 0);
         constexpr int kStops = 32;
         for (int i = 0; i <= kStops; ++i) {
           const double t = static_cast<double>(i) / kStops;
           const Color c = viridis(t);
           loaded_cairo().cairo_pattern_add_color_stop_rgb(colors, t, c.red, c.green, c.blue);
         }
         loaded_cairo().cairo_rectangle(cairo, left, top, width, em * kBarHeight);
         loaded_cairo().cairo_set_source(cairo, colors);
         loaded_cairo().cairo_fill(cairo);
         loaded_cairo().cairo_pattern_destroy(colors);
         const double bottom = top + em * kBarHeight;
         for (const Tick& tick : ticks) {
           const double x = left + (tick.value - range.low) / (range.high - range.low) * width;
           loaded_cairo().cairo_move_to(cairo, x, bottom);
           loaded_cairo().cairo_line_to(cairo, x, bottom + em * 0.25);
           set_color(cairo, kBoundaryInk);
           loaded_cairo().cairo_set_line_width(cairo, em * 0.08);
           loaded_cairo().cairo_stroke(cairo);
           put_text(cairo, {x, at.y + em * kBelow}, tick.text,
                    {.height = em * kSmall, .align = Align::kCentre});
         }
       }});
}

void Legend::add_regions(const Coloring& coloring, const NameTable& names) {
  const auto part_of = [em = em_](const std::string& text) {
    return Part{text_width(text, em),
                [=](cairo_t* cairo, PagePoint at) {
                  put_text(cairo, {at.x, at.y + em * kBaseline}, text, {.height = em});
                },
                1};
  };
  parts_.push_back(part_of("region"));
  std::size_t told = 0;
  for (const std::int32_t region : coloring.regions()) {
    if (told++ == kMaxSwatches) {
      parts_.push_back(part_of("..."));
      break;
    }
    const std::string* const name = name_of(names, region);
    const std::string text = name == nullptr ? std::to_string(region) : abbreviated(*name);
    const double indent = 1.3 * em_;
    parts_.push_back(
        {indent + text_width(text, em_),
         [=, em = em_, color = region_color(region)](cairo_t* cairo, PagePoint at) {
           loaded_cairo().cairo_rectangle(cairo, at.x, at.y + em * kBarTop, em * kBarHeight,
                                          em * kBarHeight);
           set_color(cairo, color);
           loaded_cairo().cairo_fill(cairo);
           put_text(cairo, {at.x + indent, at.y + em * kBaseline}, text, {.height = em});
         },
         0.8});
  }
  parts_.back().gap = kGap;
}

void Legend::add_colors(const Coloring& coloring, DrawnUnit unit, bool mean,
                        const NameTable& regions) {
  if (coloring.by_value()) return add_value_bar(coloring, unit, mean);
  if (coloring.by() == DrawColor::kRegion) add_regions(coloring, regions);
}

double Legend::least_width() const {
  double least = 0;
  for (const Part& part : parts_) least = std::max(least, part.width);
  return least;
}

template <class At>
double Legend::lay_out(double width, const At& at) const {
  double x = 0;
  double y = kAbove * em_;
  for (const Part& part : parts_) {
    if (x > 0 && x + part.width > width) {
      x = 0;
      y += kRow * em_;
    }
    at(part, x, y);
    x += part.width + part.gap * em_;
  }
  return parts_.empty() ? 0 : y + kRow * em_;
}

double Legend::height(double width) const {
  return lay_out(width, [](const Part&, double, double) {});
}

void Legend::draw(cairo_t* cairo, PagePoint top_left, double width) const {
  lay_out(width, [&](const Part& part, double x, double y) {
    part.draw(cairo, {top_left.x + x, top_left.y + y});
  });
}

}  // namespace weft::client
