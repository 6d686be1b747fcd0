// SPDX-License-Identifier: Apache-2.0
#include "client/drawing/labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <unordered_map>
#include <vector>

#include "client/drawing/clip.h"
#include "client/drawing/page_text.h"

namespace weft::client {
namespace {

double distance(PagePoint a, PagePoint b) {
  return std::hypot(b.x - a.x, b.y - a.y);
}

// Which cells of the page are taken.
class Room {
 public:
  Room(const Canvas& canvas, double cell)
      : cell_(cell),
        page_{0, 0, canvas.width(), canvas.height()},
        columns_(static_cast<std::size_t>(canvas.width() / cell) + 1),
        taken_(columns_ * (static_cast<std::size_t>(canvas.height() / cell) + 1)) {}

  // Takes the box if it is on the page and free.
  bool take(const PageBox& box) {
    if (!page_.contains({box.left, box.top}) || !page_.contains({box.right, box.bottom}))
      return false;
    if (!for_all(box, [](auto cell) { return !cell; })) return false;
    return for_all(box, [](auto cell) { return cell = true; });
  }

 private:
  template <class Cell>
  bool for_all(const PageBox& box, const Cell& cell) {
    const auto index = [this](double x) { return static_cast<std::size_t>(x / cell_); };
    for (std::size_t row = index(box.top); row <= index(box.bottom); ++row)
      for (std::size_t column = index(box.left); column <= index(box.right); ++column)
        if (!cell(taken_[row * columns_ + column])) return false;
    return true;
  }

  double cell_;
  PageBox page_;
  std::size_t columns_;
  std::vector<bool> taken_;
};

class LabelPainter {
 public:
  LabelPainter(cairo_t* cairo, const Canvas& canvas, double height)
      : cairo_(cairo), height_(height), room_(canvas, height / 2) {}

  double width(const std::string& text) const { return text_width(text, height_); }
  double diagonal(const std::string& text) const { return std::hypot(width(text), height_); }

  void put(PagePoint middle, const std::string& text, const Color& color) {
    const double half = width(text) / 2;
    const double above = height_ / 2;
    if (!room_.take({middle.x - half, middle.y - above, middle.x + half, middle.y + above})) return;
    constexpr double kHalfADigit = 0.36;  // of the height
    put_text(cairo_, {middle.x, middle.y + kHalfADigit * height_}, text,
             {.height = height_, .align = Align::kCentre, .halo = true, .color = color});
  }

 private:
  cairo_t* cairo_;
  double height_;
  Room room_;
};

void label_markers(LabelPainter& labels, const Canvas& canvas, std::span<const DrawnEdge> edges) {
  for (const DrawnEdge& edge : edges) {
    const PagePoint a = canvas.at(edge.a);
    const PagePoint b = canvas.at(edge.b);
    const std::string text = std::to_string(edge.marker);
    if (edge.marker != 0 && distance(a, b) >= 2.5 * labels.diagonal(text))
      labels.put({(a.x + b.x) / 2, (a.y + b.y) / 2}, text, kBoxInk);
  }
}

void label_vertices(LabelPainter& labels, const Canvas& canvas,
                    std::span<const DrawnTriangle> triangles) {
  struct Vertex {
    PagePoint at;
    double shortest_edge = 0;
  };
  std::unordered_map<std::uint32_t, Vertex> vertices;
  for (const DrawnTriangle& triangle : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const PagePoint at = canvas.at(triangle.corners[k]);
      const double edge = std::min(distance(at, canvas.at(triangle.corners[(k + 1) % 3])),
                                   distance(at, canvas.at(triangle.corners[(k + 2) % 3])));
      const auto [found, is_new] = vertices.try_emplace(triangle.vertices[k], Vertex{at, edge});
      if (!is_new) found->second.shortest_edge = std::min(found->second.shortest_edge, edge);
    }
  // In the order of the triangles, because the order of the map differs between machines.
  for (const DrawnTriangle& triangle : triangles)
    for (const std::uint32_t v : triangle.vertices) {
      const auto found = vertices.find(v);
      if (found == vertices.end()) continue;
      const std::string text = std::to_string(v);
      if (found->second.shortest_edge >= 1.5 * labels.width(text))
        labels.put(found->second.at, text, kBoundaryInk);
      vertices.erase(found);
    }
}

void label_triangles(LabelPainter& labels, const Canvas& canvas,
                     std::span<const DrawnTriangle> triangles) {
  for (const DrawnTriangle& triangle : triangles) {
    const std::array<PagePoint, 3> p = {canvas.at(triangle.corners[0]),
                                        canvas.at(triangle.corners[1]),
                                        canvas.at(triangle.corners[2])};
    const double a = distance(p[1], p[2]);
    const double b = distance(p[2], p[0]);
    const double c = distance(p[0], p[1]);
    const double around = a + b + c;
    const double twice_area =
        std::abs((p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x));
    const std::string text = std::to_string(triangle.id);
    if (!(2 * twice_area / around >= labels.diagonal(text))) continue;  // of the inscribed circle
    labels.put({(a * p[0].x + b * p[1].x + c * p[2].x) / around,
                (a * p[0].y + b * p[1].y + c * p[2].y) / around},
               text, kTriangleLabelInk);
  }
}

}  // namespace

void put_labels(cairo_t* cairo, const Canvas& canvas, std::span<const DrawnTriangle> triangles,
                std::span<const DrawnEdge> edges, double height) {
  LabelPainter labels(cairo, canvas, height);
  label_markers(labels, canvas, edges);
  label_vertices(labels, canvas, triangles);
  label_triangles(labels, canvas, triangles);
}

}  // namespace weft::client
