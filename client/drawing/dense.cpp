// SPDX-License-Identifier: Apache-2.0
#include "client/drawing/dense.h"

#include <algorithm>
#include <cmath>

namespace weft::client {
namespace {

std::size_t pixels_of(double side) {
  return std::max<std::size_t>(2, static_cast<std::size_t>(side));
}

std::uint32_t channel(double value) {
  return static_cast<std::uint32_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255));
}

}  // namespace

void DenseImage::Paint::add(const Color& color, float amount) {
  red += static_cast<float>(color.red) * amount;
  green += static_cast<float>(color.green) * amount;
  blue += static_cast<float>(color.blue) * amount;
  weight += amount;
}

DenseImage::DenseImage(const Canvas& canvas, const Coloring& coloring)
    : canvas_(canvas),
      coloring_(coloring),
      width_(pixels_of(canvas.width())),
      height_(pixels_of(canvas.height())),
      ink_(width_ * height_, 0),
      paint_(coloring.palette().empty() ? 0 : width_ * height_) {}

// Adds the colour to the pixels whose centres lie in the triangle, or, where there are none, a
// little of it to the pixel of the centroid.
void DenseImage::fill(const PagePoint (&p)[3], const Color& color) {
  const auto [left, right] = std::minmax({p[0].x, p[1].x, p[2].x});
  const auto [top, bottom] = std::minmax({p[0].y, p[1].y, p[2].y});
  const auto first = [](double low) { return static_cast<long>(std::ceil(low - 0.5)); };
  const auto last = [](double high, std::size_t size) {
    return std::min(static_cast<long>(std::floor(high - 0.5)), static_cast<long>(size) - 1);
  };
  const double area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x);
  const double turn = area < 0 ? -1 : 1;
  bool any = false;
  for (long y = std::max(0L, first(top)); y <= last(bottom, height_); ++y) {
    for (long x = std::max(0L, first(left)); x <= last(right, width_); ++x) {
      bool inside = true;
      for (std::size_t i = 0; i < 3; ++i) {
        const PagePoint& a = p[i];
        const PagePoint& b = p[i == 2 ? 0 : i + 1];
        const double side = (b.x - a.x) * (static_cast<double>(y) + 0.5 - a.y) -
                            (b.y - a.y) * (static_cast<double>(x) + 0.5 - a.x);
        inside &= side * turn >= 0;
      }
      if (!inside) continue;
      paint_[static_cast<std::size_t>(y) * width_ + static_cast<std::size_t>(x)].add(color, 1);
      any = true;
    }
  }
  if (any) return;
  const double x = std::clamp((p[0].x + p[1].x + p[2].x) / 3, 0.0, double(width_ - 1));
  const double y = std::clamp((p[0].y + p[1].y + p[2].y) / 3, 0.0, double(height_ - 1));
  paint_[static_cast<std::size_t>(y) * width_ + static_cast<std::size_t>(x)].add(
      color, static_cast<float>(std::max(std::abs(area) / 2, 1e-6)));
}

// Leaves `amount` of ink at a point, shared by the four pixels around it.
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
  constexpr double kDropsPerPixel = 1.5;
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  const auto drops = static_cast<int>(length * kDropsPerPixel) + 1;
  const auto amount = static_cast<float>(length / drops);
  for (int i = 0; i < drops; ++i) {
    const double t = (i + 0.5) / drops;
    drop(a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), amount);
  }
  length_ += length;
  ++edges_;
}

void DenseImage::add(const MeshView& piece) {
  for (std::size_t t = 0; t < piece.triangle_count(); ++t) {
    const std::uint32_t* corner = &piece.triangles[3 * t];
    const PagePoint p[3] = {canvas_.vertex(piece, corner[0]), canvas_.vertex(piece, corner[1]),
                            canvas_.vertex(piece, corner[2])};
    for (std::size_t k = 0; k < 3; ++k)
      if (const std::size_t next = k == 2 ? 0 : k + 1; corner[k] < corner[next])
        stroke(p[k], p[next]);
    if (!paint_.empty()) fill(p, coloring_.palette()[coloring_.of(piece, t)]);
  }
}

double DenseImage::mean_edge() const {
  return edges_ > 0 ? length_ / static_cast<double>(edges_) : 0;
}

Image DenseImage::image() const {
  // Lines as wide as leaves the page grey on average.
  constexpr double kMeanInk = 0.45;
  constexpr double kWidest = 0.7;
  const double area = static_cast<double>(width_) * static_cast<double>(height_);
  const double line_width = std::min(kWidest, kMeanInk * area / std::max(length_, 1.0));
  // Over colours, edges are only hinted at.
  const double strength = paint_.empty() ? 1 : 0.45;
  Image image{width_, height_, std::vector<std::uint32_t>(width_ * height_)};
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    Color color = kPaper;
    if (!paint_.empty() && paint_[i].weight > 0)
      color = {paint_[i].red / paint_[i].weight, paint_[i].green / paint_[i].weight,
               paint_[i].blue / paint_[i].weight};
    const double cover = strength * (1 - std::exp(-line_width * double{ink_[i]}));
    image.pixels[i] = channel(color.red + cover * (kEdgeInk.red - color.red)) << 16 |
                      channel(color.green + cover * (kEdgeInk.green - color.green)) << 8 |
                      channel(color.blue + cover * (kEdgeInk.blue - color.blue));
  }
  return image;
}

}  // namespace weft::client
