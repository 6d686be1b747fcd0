// SPDX-License-Identifier: Apache-2.0
#include "client/drawing/dense.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace weft::client {
namespace {

std::size_t pixels_of(double side) {
  return std::max<std::size_t>(2, static_cast<std::size_t>(side));
}

std::uint32_t channel(double value) {
  return static_cast<std::uint32_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255));
}

// The pixels whose centres lie between two places, of `size` pixels: the first one, and one past
// the last.
std::pair<std::size_t, std::size_t> centres_between(double low, double high, std::size_t size) {
  const auto last = static_cast<double>(size);
  const auto first = std::ceil(std::clamp(low - 0.5, 0.0, last));
  const auto end = std::floor(std::clamp(high + 0.5, 0.0, last));
  return {static_cast<std::size_t>(first), static_cast<std::size_t>(std::max(first, end))};
}

}  // namespace

void DenseImage::ColorPaint::add(const Color& color, float amount) {
  red += static_cast<float>(color.red) * amount;
  green += static_cast<float>(color.green) * amount;
  blue += static_cast<float>(color.blue) * amount;
  weight += amount;
}

DenseImage::DenseImage(const Canvas& canvas, Coloring& coloring)
    : canvas_(canvas),
      coloring_(coloring),
      width_(pixels_of(canvas.width())),
      height_(pixels_of(canvas.height())),
      box_{0, 0, static_cast<double>(width_), static_cast<double>(height_)},
      ink_(width_ * height_, 0),
      values_(coloring.by_value() ? width_ * height_ : 0),
      colors_(coloring.by() == DrawColor::kRegion ? width_ * height_ : 0) {}

// Adds the value to the pixels whose centres lie in the triangle. If there are none, adds a part of
// it to the pixel of the centroid.
template <class Paint, class Value>
void DenseImage::fill(const Corners& p, double area, std::vector<Paint>& paint,
                      const Value& value) {
  const auto [top, bottom] = std::minmax({p[0].y, p[1].y, p[2].y});
  const auto [first_row, end_row] = centres_between(top, bottom, height_);
  bool any = false;
  for (std::size_t row = first_row; row < end_row; ++row) {
    const double y = static_cast<double>(row) + 0.5;
    double left = box_.right;
    double right = box_.left;
    for (std::size_t i = 0; i < 3; ++i) {
      const PagePoint& a = p[i];
      const PagePoint& b = p[i == 2 ? 0 : i + 1];
      if ((a.y > y) == (b.y > y) && a.y != y) continue;
      const double x = a.y == y ? a.x : a.x + (y - a.y) * (b.x - a.x) / (b.y - a.y);
      left = std::min(left, x);
      right = std::max(right, x);
    }
    if (left > right) continue;
    const auto [first, end] = centres_between(left, right, width_);
    for (std::size_t column = first; column < end; ++column)
      paint[row * width_ + column].add(value, 1);
    any |= first < end;
  }
  if (any) return;
  const PagePoint middle{(p[0].x + p[1].x + p[2].x) / 3, (p[0].y + p[1].y + p[2].y) / 3};
  if (!box_.contains(middle)) return;
  const auto column = std::min(static_cast<std::size_t>(middle.x), width_ - 1);
  const auto row = std::min(static_cast<std::size_t>(middle.y), height_ - 1);
  paint[row * width_ + column].add(value, static_cast<float>(std::max(area, 1e-6)));
}

// Adds `amount` of ink at a point, divided among the four pixels around it.
void DenseImage::drop(double x, double y, float amount) {
  const double column = std::clamp(x - 0.5, 0.0, static_cast<double>(width_) - 1.001);
  const double row = std::clamp(y - 0.5, 0.0, static_cast<double>(height_) - 1.001);
  const auto c = static_cast<std::size_t>(column);
  const auto r = static_cast<std::size_t>(row);
  const auto u = static_cast<float>(column - static_cast<double>(c));
  const auto v = static_cast<float>(row - static_cast<double>(r));
  float* at = &ink_[r * width_ + c];
  at[0] += amount * (1 - u) * (1 - v);
  at[1] += amount * u * (1 - v);
  at[width_] += amount * (1 - u) * v;
  at[width_ + 1] += amount * u * v;
}

void DenseImage::stroke(PagePoint a, PagePoint b) {
  if (!box_.contains(a) || !box_.contains(b)) {
    const auto seen = clipped(box_, a, b);
    if (!seen) return;
    std::tie(a, b) = *seen;
  }
  constexpr double kDropsPerPixel = 1.5;
  const double length = std::sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
  const auto drops = static_cast<int>(length * kDropsPerPixel) + 1;
  const auto amount = static_cast<float>(length / drops);
  for (int i = 0; i < drops; ++i) {
    const double t = (i + 0.5) / drops;
    drop(a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), amount);
  }
  length_ += length;
  ++edges_;
}

void DenseImage::add(const DrawnTriangle& triangle) {
  const Corners p = {canvas_.at(triangle.corners[0]), canvas_.at(triangle.corners[1]),
                     canvas_.at(triangle.corners[2])};
  const auto [left, right] = std::minmax({p[0].x, p[1].x, p[2].x});
  const auto [top, bottom] = std::minmax({p[0].y, p[1].y, p[2].y});
  if (right < box_.left || left > box_.right || bottom < box_.top || top > box_.bottom) return;
  for (std::size_t k = 0; k < 3; ++k)
    if (const std::size_t next = k == 2 ? 0 : k + 1; triangle.vertices[k] < triangle.vertices[next])
      stroke(p[k], p[next]);
  const double area =
      std::abs((p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x)) / 2;
  if (!values_.empty()) {
    const float value = coloring_.value(triangle);
    coloring_.note(value, std::min(area, box_.right * box_.bottom));
    fill(p, area, values_, value);
  } else if (!colors_.empty()) {
    coloring_.note_region(triangle.region);
    fill(p, area, colors_, region_color(triangle.region));
  }
}

double DenseImage::mean_edge() const {
  return edges_ > 0 ? length_ / static_cast<double>(edges_) : 0;
}

Image DenseImage::image() const {
  // Lines are so wide that the page is grey on average.
  constexpr double kMeanInk = 0.45;
  constexpr double kWidest = 0.7;
  const double pixels = static_cast<double>(width_) * static_cast<double>(height_);
  const double line_width = std::min(kWidest, kMeanInk * pixels / std::max(length_, 1.0));
  // Over colours, edges are drawn faintly, and not at all if they are as short as pixels.
  constexpr double kHint = 0.45;
  constexpr double kNoHint = 1.5;
  constexpr double kFullHint = 5;
  const bool colored = !values_.empty() || !colors_.empty();
  const double strength =
      colored ? kHint * std::clamp((mean_edge() - kNoHint) / (kFullHint - kNoHint), 0.0, 1.0) : 1;
  const ValueRange range = coloring_.range();
  Image image{width_, height_, std::vector<std::uint32_t>(width_ * height_)};
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    Color color = kPaper;
    if (!values_.empty() && values_[i].weight > 0)
      color = Coloring::color(values_[i].sum / values_[i].weight, range);
    if (!colors_.empty() && colors_[i].weight > 0)
      color = {colors_[i].red / colors_[i].weight, colors_[i].green / colors_[i].weight,
               colors_[i].blue / colors_[i].weight};
    const double cover = strength * (1 - std::exp(-line_width * double{ink_[i]}));
    image.pixels[i] = channel(color.red + cover * (kEdgeInk.red - color.red)) << 16 |
                      channel(color.green + cover * (kEdgeInk.green - color.green)) << 8 |
                      channel(color.blue + cover * (kEdgeInk.blue - color.blue));
  }
  return image;
}

}  // namespace weft::client
