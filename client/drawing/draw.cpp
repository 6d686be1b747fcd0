// SPDX-License-Identifier: Apache-2.0
#include "client/drawing/draw.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "client/drawing/canvas.h"
#include "client/drawing/coloring.h"
#include "client/drawing/colors.h"
#include "client/drawing/dense.h"

namespace weft::client {
namespace {

struct DestroySurface {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
struct DestroyContext {
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};
using Surface = std::unique_ptr<cairo_surface_t, DestroySurface>;
using Context = std::unique_ptr<cairo_t, DestroyContext>;

constexpr double kMarginsPerSide = 60;
constexpr double kBoxLine = 1.5;  // pixels
// Long paths slow cairo down.
constexpr std::size_t kEdgesPerPath = 1000;

cairo_status_t write_to_file(void* file, const unsigned char* bytes, unsigned size) {
  static_cast<OutputFile*>(file)->write(bytes, size);
  return CAIRO_STATUS_SUCCESS;  // the file keeps its failure
}

Surface make_surface(DrawFormat format, const Canvas& canvas, OutputFile& file) {
  switch (format) {
    case DrawFormat::kPng:
      return Surface(cairo_image_surface_create(
          CAIRO_FORMAT_RGB24, static_cast<int>(canvas.width()), static_cast<int>(canvas.height())));
    case DrawFormat::kSvg:
      return Surface(cairo_svg_surface_create_for_stream(write_to_file, &file, canvas.width(),
                                                         canvas.height()));
    case DrawFormat::kPdf:
      break;
  }
  return Surface(
      cairo_pdf_surface_create_for_stream(write_to_file, &file, canvas.width(), canvas.height()));
}

void set_color(cairo_t* cairo, const Color& color, double alpha = 1) {
  cairo_set_source_rgba(cairo, color.red, color.green, color.blue, alpha);
}

// Mean length of the inner edges, on the page.
double mean_edge(const MeshView& mesh, const Canvas& canvas) {
  double sum = 0;
  std::size_t count = 0;
  for_each_inner_edge(mesh, [&](std::uint32_t a, std::uint32_t b) {
    const PagePoint p = canvas.vertex(mesh, a);
    const PagePoint q = canvas.vertex(mesh, b);
    sum += std::hypot(q.x - p.x, q.y - p.y);
    ++count;
  });
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

void line(cairo_t* cairo, PagePoint a, PagePoint b) {
  cairo_move_to(cairo, a.x, a.y);
  cairo_line_to(cairo, b.x, b.y);
}

void draw_image(cairo_t* cairo, Image image, const Canvas& page) {
  const Surface surface(cairo_image_surface_create_for_data(
      reinterpret_cast<unsigned char*>(image.pixels.data()), CAIRO_FORMAT_RGB24,
      static_cast<int>(image.width), static_cast<int>(image.height),
      static_cast<int>(image.width * sizeof(std::uint32_t))));
  cairo_save(cairo);
  cairo_scale(cairo, page.width() / static_cast<double>(image.width),
              page.height() / static_cast<double>(image.height));
  cairo_set_source_surface(cairo, surface.get(), 0, 0);
  cairo_paint(cairo);
  cairo_restore(cairo);
  cairo_surface_flush(cairo_get_target(cairo));
}

void stroke_boxes(cairo_t* cairo, std::span<const double> boxes, const Canvas& canvas) {
  for (std::size_t i = 0; i + 3 < boxes.size(); i += 4) {
    const PagePoint low = canvas.at(boxes[i], boxes[i + 1]);
    const PagePoint high = canvas.at(boxes[i + 2], boxes[i + 3]);
    cairo_rectangle(cairo, low.x, high.y, high.x - low.x, low.y - high.y);
    cairo_stroke(cairo);
  }
}

}  // namespace

Drawing::Drawing(DrawColor color, double long_side)
    : coloring_(std::make_unique<Coloring>(color)), long_side_(long_side) {}

Drawing::~Drawing() = default;

Canvas Drawing::canvas(double long_side) const {
  return {extent_, long_side, long_side / kMarginsPerSide};
}

void Drawing::keep(const MeshView& piece) {
  const auto append = [](auto& to, auto values) {
    to.insert(to.end(), values.begin(), values.end());
  };
  const auto vertices = piece.coordinates.subspan(mesh_.coordinates.size());
  extent_.add(vertices);
  append(mesh_.coordinates, vertices);
  append(mesh_.triangles, piece.triangles);
  append(mesh_.regions, piece.regions);
  mesh_.regions.resize(mesh_.triangles.size() / 3);
}

void Drawing::draw_as_image() {
  image_ = std::make_unique<DenseImage>(canvas(long_side_), *coloring_);
  image_->add(mesh_.view());
  mesh_ = {};
}

void Drawing::add(const MeshView& piece) {
  triangles_ += piece.triangle_count();
  for (const std::uint32_t v : piece.edges) {
    boundary_.push_back(piece.coordinates[2 * std::size_t{v}]);
    boundary_.push_back(piece.coordinates[2 * std::size_t{v} + 1]);
  }
  if (image_) return image_->add(piece);
  keep(piece);
  if (triangles_ > kMostVectors) draw_as_image();
}

void Drawing::fill_triangles(cairo_t* cairo, const Canvas& canvas) const {
  const MeshView mesh = mesh_.view();
  const std::vector<Color>& palette = coloring_->palette();
  // By colour: one path for many triangles.
  std::vector<std::vector<std::uint32_t>> of_color(palette.size());
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
    of_color[coloring_->of(mesh, t)].push_back(t);
  cairo_set_antialias(cairo, CAIRO_ANTIALIAS_NONE);  // no seams between neighbours
  for (std::size_t c = 0; c < of_color.size(); ++c) {
    set_color(cairo, palette[c]);
    for (std::size_t i = 0; i < of_color[c].size(); ++i) {
      const std::uint32_t* corner = &mesh.triangles[3 * std::size_t{of_color[c][i]}];
      for (int k = 0; k < 3; ++k) {
        const PagePoint p = canvas.vertex(mesh, corner[k]);
        k == 0 ? cairo_move_to(cairo, p.x, p.y) : cairo_line_to(cairo, p.x, p.y);
      }
      cairo_close_path(cairo);
      if ((i + 1) % kEdgesPerPath == 0) cairo_fill(cairo);
    }
    cairo_fill(cairo);
  }
  cairo_set_antialias(cairo, CAIRO_ANTIALIAS_DEFAULT);
}

void Drawing::stroke_inner_edges(cairo_t* cairo, const Canvas& canvas) const {
  const MeshView mesh = mesh_.view();
  std::size_t count = 0;
  for_each_inner_edge(mesh, [&](std::uint32_t a, std::uint32_t b) {
    line(cairo, canvas.vertex(mesh, a), canvas.vertex(mesh, b));
    if (++count % kEdgesPerPath == 0) cairo_stroke(cairo);
  });
  cairo_stroke(cairo);
}

void Drawing::stroke_boundary(cairo_t* cairo, const Canvas& canvas) const {
  for (std::size_t e = 0; e < boundary_.size() / 4; ++e) {
    const double* ends = &boundary_[4 * e];
    line(cairo, canvas.at(ends[0], ends[1]), canvas.at(ends[2], ends[3]));
    if ((e + 1) % kEdgesPerPath == 0) cairo_stroke(cairo);
  }
  cairo_stroke(cairo);
}

Result<void> Drawing::draw(DrawFormat format, std::span<const double> boxes,
                           OutputFile& file) const {
  const double pixel = format == DrawFormat::kPng ? 1 : 0.5;  // in units of the page
  const Canvas page = canvas(long_side_ * pixel);
  const Surface surface = make_surface(format, page, file);
  const Context context(cairo_create(surface.get()));
  cairo_t* cairo = context.get();
  set_color(cairo, kPaper);
  cairo_paint(cairo);
  cairo_set_line_cap(cairo, CAIRO_LINE_CAP_ROUND);

  const double edge = image_ ? image_->mean_edge() : mean_edge(mesh_.view(), page) / pixel;
  constexpr double kDenseEdge = 5;  // pixels
  if (image_) {
    draw_image(cairo, image_->image(), page);
  } else if (edge < kDenseEdge) {
    DenseImage image(canvas(long_side_), *coloring_);
    image.add(mesh_.view());
    draw_image(cairo, image.image(), page);
  } else {
    const bool colored = !coloring_->palette().empty();
    if (colored) fill_triangles(cairo, page);
    set_color(cairo, kEdgeInk, colored ? 0.6 : 1);
    cairo_set_line_width(cairo, pixel * std::clamp(0.07 * edge, 0.3, 1.2));
    stroke_inner_edges(cairo, page);
  }
  set_color(cairo, kBoundaryInk);
  cairo_set_line_width(cairo, pixel * std::clamp(0.15 * edge, 1.3, 2.6));
  stroke_boundary(cairo, page);
  set_color(cairo, kBoxInk);
  cairo_set_line_width(cairo, pixel * kBoxLine);
  stroke_boxes(cairo, boxes, page);

  cairo_status_t status = cairo_status(cairo);
  if (status == CAIRO_STATUS_SUCCESS && format == DrawFormat::kPng)
    status = cairo_surface_write_to_png_stream(surface.get(), write_to_file, &file);
  cairo_surface_finish(surface.get());
  if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(surface.get());
  if (status != CAIRO_STATUS_SUCCESS)
    return fail(ExitCode::kInternal,
                file.target().string() + ": cannot be drawn: " + cairo_status_to_string(status));
  return {};
}

}  // namespace weft::client
