// SPDX-License-Identifier: Apache-2.0
#include "client/drawing/dense.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace weft::client {
namespace {

struct Page {
  std::size_t width;
  std::size_t height;
};

// Sums of the colours in a pixel, and how many.
struct Paint {
  float red = 0;
  float green = 0;
  float blue = 0;
  float weight = 0;

  void add(const Color& color, float amount) {
    red += static_cast<float>(color.red) * amount;
    green += static_cast<float>(color.green) * amount;
    blue += static_cast<float>(color.blue) * amount;
    weight += amount;
  }
};

// Adds the colour to the pixels whose centres lie in the triangle, or, where there are none, a
// little of it to the pixel of the centroid.
void fill(const std::array<PagePoint, 3>& p, const Color& color, Page page,
          std::vector<Paint>& paint) {
  const auto [left, right] = std::minmax({p[0].x, p[1].x, p[2].x});
  const auto [top, bottom] = std::minmax({p[0].y, p[1].y, p[2].y});
  const auto first = [](double low) { return static_cast<long>(std::ceil(low - 0.5)); };
  const auto last = [](double high, std::size_t size) {
    return std::min(static_cast<long>(std::floor(high - 0.5)), static_cast<long>(size) - 1);
  };
  const double area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x);
  const double turn = area < 0 ? -1 : 1;
  bool any = false;
  for (long y = std::max(0L, first(top)); y <= last(bottom, page.height); ++y) {
    for (long x = std::max(0L, first(left)); x <= last(right, page.width); ++x) {
      bool inside = true;
      for (std::size_t i = 0; i < 3; ++i) {
        const PagePoint& a = p[i];
        const PagePoint& b = p[i == 2 ? 0 : i + 1];
        const double side = (b.x - a.x) * (static_cast<double>(y) + 0.5 - a.y) -
                            (b.y - a.y) * (static_cast<double>(x) + 0.5 - a.x);
        inside &= side * turn >= 0;
      }
      if (!inside) continue;
      paint[static_cast<std::size_t>(y) * page.width + static_cast<std::size_t>(x)].add(color, 1);
      any = true;
    }
  }
  if (any) return;
  const double x = std::clamp((p[0].x + p[1].x + p[2].x) / 3, 0.0, double(page.width - 1));
  const double y = std::clamp((p[0].y + p[1].y + p[2].y) / 3, 0.0, double(page.height - 1));
  paint[static_cast<std::size_t>(y) * page.width + static_cast<std::size_t>(x)].add(
      color, static_cast<float>(std::max(std::abs(area) / 2, 1e-6)));
}

// Leaves `amount` of ink at a point, shared by the four pixels around it.
void drop(double x, double y, float amount, Page page, std::vector<float>& ink) {
  const double column = std::clamp(x - 0.5, 0.0, static_cast<double>(page.width) - 1.001);
  const double row = std::clamp(y - 0.5, 0.0, static_cast<double>(page.height) - 1.001);
  const auto c = static_cast<std::size_t>(column);
  const auto r = static_cast<std::size_t>(row);
  const auto u = static_cast<float>(column - static_cast<double>(c));
  const auto v = static_cast<float>(row - static_cast<double>(r));
  float* at = &ink[r * page.width + c];
  at[0] += amount * (1 - u) * (1 - v);
  at[1] += amount * u * (1 - v);
  at[page.width] += amount * (1 - u) * v;
  at[page.width + 1] += amount * u * v;
}

std::vector<float> ink_of_edges(const MeshView& mesh, const Canvas& canvas, Page page) {
  double total = 0;
  for_each_inner_edge(mesh, [&](std::uint32_t a, std::uint32_t b) {
    const PagePoint p = canvas.vertex(mesh, a);
    const PagePoint q = canvas.vertex(mesh, b);
    total += std::hypot(q.x - p.x, q.y - p.y);
  });
  // Lines as wide as leaves the page grey on average.
  constexpr double kMeanInk = 0.45;
  constexpr double kWidest = 0.7;
  const double area = static_cast<double>(page.width) * static_cast<double>(page.height);
  const double line_width = std::min(kWidest, kMeanInk * area / std::max(total, 1.0));

  std::vector<float> ink(page.width * page.height, 0);
  for_each_inner_edge(mesh, [&](std::uint32_t a, std::uint32_t b) {
    const PagePoint p = canvas.vertex(mesh, a);
    const PagePoint q = canvas.vertex(mesh, b);
    const double length = std::hypot(q.x - p.x, q.y - p.y);
    constexpr double kDropsPerPixel = 1.5;
    const auto drops = static_cast<int>(length * kDropsPerPixel) + 1;
    const auto amount = static_cast<float>(length * line_width / drops);
    for (int i = 0; i < drops; ++i) {
      const double t = (i + 0.5) / drops;
      drop(p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), amount, page, ink);
    }
  });
  return ink;
}

std::uint32_t channel(double value) {
  return static_cast<std::uint32_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255));
}

}  // namespace

Raster rasterize(const MeshView& mesh, const Canvas& canvas, const std::vector<Color>& palette,
                 const std::vector<std::uint8_t>& palette_index) {
  const Page page{std::max<std::size_t>(2, static_cast<std::size_t>(canvas.width())),
                  std::max<std::size_t>(2, static_cast<std::size_t>(canvas.height()))};
  const std::vector<float> ink = ink_of_edges(mesh, canvas, page);
  std::vector<Paint> paint(palette_index.empty() ? 0 : page.width * page.height);
  for (std::size_t t = 0; t < palette_index.size(); ++t)
    fill(
        {canvas.vertex(mesh, mesh.triangles[3 * t]), canvas.vertex(mesh, mesh.triangles[3 * t + 1]),
         canvas.vertex(mesh, mesh.triangles[3 * t + 2])},
        palette[palette_index[t]], page, paint);

  // Over colours, edges are only hinted at.
  const double strength = palette_index.empty() ? 1 : 0.45;
  Raster raster{page.width, page.height, std::vector<std::uint32_t>(page.width * page.height)};
  for (std::size_t i = 0; i < raster.pixels.size(); ++i) {
    Color color = kPaper;
    if (!paint.empty() && paint[i].weight > 0)
      color = {paint[i].red / paint[i].weight, paint[i].green / paint[i].weight,
               paint[i].blue / paint[i].weight};
    const double cover = strength * (1 - std::exp(-double{ink[i]}));
    raster.pixels[i] = channel(color.red + cover * (kEdgeInk.red - color.red)) << 16 |
                       channel(color.green + cover * (kEdgeInk.green - color.green)) << 8 |
                       channel(color.blue + cover * (kEdgeInk.blue - color.blue));
  }
  return raster;
}

}  // namespace weft::client
