// SPDX-License-Identifier: Apache-2.0
#include "client/drawing/vectors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "client/drawing/cairo_library.h"
#include "client/drawing/page_text.h"

namespace weft::client {
namespace {

// cairo becomes slow with long paths.
constexpr std::size_t kMaxOfAPath = 1000;

std::array<PagePoint, 3> on_page(const DrawnTriangle& triangle, const Canvas& canvas) {
  return {canvas.at(triangle.corners[0]), canvas.at(triangle.corners[1]),
          canvas.at(triangle.corners[2])};
}

// Calls edge(a, b) once for each edge between two triangles; the corners are indices of a triangle.
// (Counter-clockwise triangles name such an edge once in each direction; edges of only one triangle
// may be left out.)
template <class Edge>
void for_each_inner_edge(std::span<const DrawnTriangle> triangles, const Edge& edge) {
  for (const DrawnTriangle& triangle : triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (const std::size_t next = k == 2 ? 0 : k + 1;
          triangle.vertices[k] < triangle.vertices[next])
        edge(triangle.corners[k], triangle.corners[next]);
}

}  // namespace

Vectors::Vectors(cairo_t* cairo, const Canvas& canvas, double pixel)
    : cairo_(cairo), canvas_(canvas), pixel_(pixel), box_{0, 0, canvas.width(), canvas.height()} {}

void Vectors::stroke(std::span<const Line> lines, const Color& color, double alpha, double width) {
  set_color(cairo_, color, alpha);
  loaded_cairo().cairo_set_line_width(cairo_, width);
  std::size_t count = 0;
  for (const Line& line : lines) {
    const auto seen = clipped(box_, line.a, line.b);
    if (!seen) continue;
    loaded_cairo().cairo_move_to(cairo_, seen->first.x, seen->first.y);
    loaded_cairo().cairo_line_to(cairo_, seen->second.x, seen->second.y);
    if (++count % kMaxOfAPath == 0) loaded_cairo().cairo_stroke(cairo_);
  }
  loaded_cairo().cairo_stroke(cairo_);
}

void Vectors::stroke_inner_edges(std::span<const DrawnTriangle> triangles, bool over_colors) {
  constexpr double kWidthOfALength = 0.07;
  constexpr double kThinnest = 0.1;  // pixels
  constexpr double kThickest = 1.2;
  constexpr int kClasses = 8;  // classes of widths, each wider by the same factor
  const double step = std::log(kThickest / kThinnest) / (kClasses - 1);
  std::array<std::vector<Line>, kClasses> lines;
  for_each_inner_edge(triangles, [&](const Point& p, const Point& q) {
    const PagePoint a = canvas_.at(p);
    const PagePoint b = canvas_.at(q);
    const double length = std::hypot(b.x - a.x, b.y - a.y) / pixel_;
    const double width = std::clamp(kWidthOfALength * length, kThinnest, kThickest);
    lines[static_cast<std::size_t>(std::lround(std::log(width / kThinnest) / step))].push_back(
        {a, b});
  });
  for (std::size_t i = 0; i < lines.size(); ++i)
    stroke(lines[i], kEdgeInk, over_colors ? 0.6 : 1,
           pixel_ * kThinnest * std::exp(step * static_cast<double>(i)));
}

void Vectors::stroke_outline(std::span<const DrawnTriangle> triangles, double pixels) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, Line> once;
  for (const DrawnTriangle& triangle : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = k == 2 ? 0 : k + 1;
      const auto ends = std::minmax(triangle.vertices[k], triangle.vertices[next]);
      const auto [found, is_new] = once.try_emplace(
          ends, Line{canvas_.at(triangle.corners[k]), canvas_.at(triangle.corners[next])});
      if (!is_new) once.erase(found);
    }
  std::vector<Line> lines;
  for (const auto& [ends, line] : once) lines.push_back(line);
  stroke(lines, kBoundaryInk, 1, pixel_ * pixels);
}

void Vectors::stroke_edges(std::span<const DrawnEdge> edges, double pixels) {
  std::vector<Line> lines;
  for (const DrawnEdge& edge : edges) lines.push_back({canvas_.at(edge.a), canvas_.at(edge.b)});
  stroke(lines, kBoundaryInk, 1, pixel_ * pixels);
}

void Vectors::stroke_boxes(std::span<const double> boxes, double pixels) {
  std::vector<Line> lines;
  for (std::size_t i = 0; i + 3 < boxes.size(); i += 4) {
    const std::array<PagePoint, 4> p = {
        canvas_.at(boxes[i], boxes[i + 1]), canvas_.at(boxes[i + 2], boxes[i + 1]),
        canvas_.at(boxes[i + 2], boxes[i + 3]), canvas_.at(boxes[i], boxes[i + 3])};
    for (std::size_t k = 0; k < 4; ++k) lines.push_back({p[k], p[(k + 1) % 4]});
  }
  stroke(lines, kBoxInk, 1, pixel_ * pixels);
}

void Vectors::fill_one_color(std::span<const DrawnTriangle> triangles,
                             std::span<const std::uint32_t> some, const Color& color) {
  set_color(cairo_, color);
  std::size_t count = 0;
  for (const std::uint32_t t : some) {
    const ClippedTriangle seen(box_, on_page(triangles[t], canvas_));
    if (seen.corners().size() < 3) continue;
    loaded_cairo().cairo_new_sub_path(cairo_);
    for (const PagePoint& p : seen.corners()) loaded_cairo().cairo_line_to(cairo_, p.x, p.y);
    loaded_cairo().cairo_close_path(cairo_);
    if (++count % kMaxOfAPath == 0) loaded_cairo().cairo_fill(cairo_);
  }
  loaded_cairo().cairo_fill(cairo_);
}

void Vectors::fill(std::span<const DrawnTriangle> triangles, const Coloring& coloring) {
  // Triangles by colour: one path for many of them.
  constexpr double kSteps = 255;
  const ValueRange range = coloring.range();
  struct OneColor {
    Color color;
    std::vector<std::uint32_t> triangles;
  };
  std::map<std::int64_t, OneColor> colors;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (coloring.by_value()) {
      const double part =
          std::clamp((coloring.value(triangles[t]) - range.low) / (range.high - range.low), 0., 1.);
      const std::int64_t step = std::lround(part * kSteps);
      OneColor& one = colors[step];
      one.color = viridis(static_cast<double>(step) / kSteps);
      one.triangles.push_back(t);
    } else {
      const std::int32_t region = triangles[t].region;
      OneColor& one = colors[region];
      one.color = region_color(region);
      one.triangles.push_back(t);
    }
  }
  loaded_cairo().cairo_set_antialias(cairo_, CAIRO_ANTIALIAS_NONE);  // no seams between neighbours
  for (const auto& [key, one] : colors) fill_one_color(triangles, one.triangles, one.color);
  loaded_cairo().cairo_set_antialias(cairo_, CAIRO_ANTIALIAS_DEFAULT);
}

double mean_inner_edge(std::span<const DrawnTriangle> triangles, const Canvas& canvas) {
  double sum = 0;
  std::size_t count = 0;
  for_each_inner_edge(triangles, [&](const Point& p, const Point& q) {
    const PagePoint a = canvas.at(p);
    const PagePoint b = canvas.at(q);
    sum += std::hypot(b.x - a.x, b.y - a.y);
    ++count;
  });
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

void note_all(std::span<const DrawnTriangle> triangles, const Canvas& canvas, Coloring& coloring) {
  for (const DrawnTriangle& triangle : triangles) {
    if (coloring.by() == DrawColor::kRegion) coloring.note_region(triangle.region);
    if (!coloring.by_value()) continue;
    const auto p = on_page(triangle, canvas);
    const double on_the_page =
        std::abs((p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x)) / 2;
    coloring.note(coloring.value(triangle),
                  std::min(on_the_page, canvas.width() * canvas.height()));
  }
}

}  // namespace weft::client
