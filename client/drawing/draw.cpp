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
#include "client/drawing/colors.h"
#include "client/drawing/dense.h"
#include "client/mesh_angles.h"

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

Surface make_surface(const DrawOptions& options, const Canvas& canvas, OutputFile& file) {
  switch (options.format) {
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

// The colours in use, and which one each triangle has.
struct Coloring {
  std::vector<Color> palette;
  std::vector<std::uint8_t> index;  // empty: triangles are not coloured
};

Coloring color_triangles(const MeshView& mesh, DrawColor by) {
  Coloring coloring;
  if (by == DrawColor::kNone) return coloring;
  coloring.index.resize(mesh.triangle_count());
  if (by == DrawColor::kAngle) {
    constexpr int kSteps = 120;  // half a degree each
    for (int i = 0; i <= kSteps; ++i)
      coloring.palette.push_back(viridis(static_cast<double>(i) / kSteps));
    for (std::size_t t = 0; t < coloring.index.size(); ++t)
      coloring.index[t] =
          static_cast<std::uint8_t>(std::lround(triangle_angles(mesh, t).min_deg / 60 * kSteps));
    return coloring;
  }
  constexpr std::int32_t kPeriod = 8;  // region 0, then the ids modulo the number of colours
  for (std::int32_t id = 0; id <= kPeriod; ++id) coloring.palette.push_back(region_color(id));
  for (std::size_t t = 0; t < coloring.index.size(); ++t) {
    const std::int64_t id = mesh.regions[t];
    if (id != 0)
      coloring.index[t] = static_cast<std::uint8_t>(((id - 1) % kPeriod + kPeriod) % kPeriod + 1);
  }
  return coloring;
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

void draw_raster(cairo_t* cairo, const MeshView& mesh, const DrawOptions& options,
                 const Coloring& coloring, const Canvas& page) {
  const Canvas canvas(mesh, options.long_side, options.long_side / kMarginsPerSide);
  Raster raster = rasterize(mesh, canvas, coloring.palette, coloring.index);
  const Surface image(cairo_image_surface_create_for_data(
      reinterpret_cast<unsigned char*>(raster.pixels.data()), CAIRO_FORMAT_RGB24,
      static_cast<int>(raster.width), static_cast<int>(raster.height),
      static_cast<int>(raster.width * sizeof(std::uint32_t))));
  cairo_save(cairo);
  cairo_scale(cairo, page.width() / static_cast<double>(raster.width),
              page.height() / static_cast<double>(raster.height));
  cairo_set_source_surface(cairo, image.get(), 0, 0);
  cairo_paint(cairo);
  cairo_restore(cairo);
  cairo_surface_flush(cairo_get_target(cairo));
}

void fill_triangles(cairo_t* cairo, const MeshView& mesh, const Coloring& coloring,
                    const Canvas& canvas) {
  // By colour: one path for many triangles.
  std::vector<std::vector<std::uint32_t>> of_color(coloring.palette.size());
  for (std::uint32_t t = 0; t < coloring.index.size(); ++t)
    of_color[coloring.index[t]].push_back(t);
  cairo_set_antialias(cairo, CAIRO_ANTIALIAS_NONE);  // no seams between neighbours
  for (std::size_t c = 0; c < of_color.size(); ++c) {
    set_color(cairo, coloring.palette[c]);
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

void stroke_inner_edges(cairo_t* cairo, const MeshView& mesh, const Canvas& canvas) {
  std::size_t count = 0;
  for_each_inner_edge(mesh, [&](std::uint32_t a, std::uint32_t b) {
    line(cairo, canvas.vertex(mesh, a), canvas.vertex(mesh, b));
    if (++count % kEdgesPerPath == 0) cairo_stroke(cairo);
  });
  cairo_stroke(cairo);
}

void stroke_boundary(cairo_t* cairo, const MeshView& mesh, const Canvas& canvas) {
  for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
    line(cairo, canvas.vertex(mesh, mesh.edges[2 * e]), canvas.vertex(mesh, mesh.edges[2 * e + 1]));
    if ((e + 1) % kEdgesPerPath == 0) cairo_stroke(cairo);
  }
  cairo_stroke(cairo);
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

Result<void> draw(const MeshView& mesh, const DrawOptions& options, OutputFile& file) {
  const double pixel = options.format == DrawFormat::kPng ? 1 : 0.5;  // in units of the page
  const double long_side = options.long_side * pixel;
  const Canvas canvas(mesh, long_side, long_side / kMarginsPerSide);
  const Surface surface = make_surface(options, canvas, file);
  const Context context(cairo_create(surface.get()));
  cairo_t* cairo = context.get();
  set_color(cairo, kPaper);
  cairo_paint(cairo);
  cairo_set_line_cap(cairo, CAIRO_LINE_CAP_ROUND);

  const Coloring coloring = color_triangles(mesh, options.color);
  const double edge = mean_edge(mesh, canvas) / pixel;
  constexpr double kDenseEdge = 5;  // pixels
  if (edge < kDenseEdge) {
    draw_raster(cairo, mesh, options, coloring, canvas);
  } else {
    if (!coloring.index.empty()) fill_triangles(cairo, mesh, coloring, canvas);
    set_color(cairo, kEdgeInk, coloring.index.empty() ? 1 : 0.6);
    cairo_set_line_width(cairo, pixel * std::clamp(0.07 * edge, 0.3, 1.2));
    stroke_inner_edges(cairo, mesh, canvas);
  }
  set_color(cairo, kBoundaryInk);
  cairo_set_line_width(cairo, pixel * std::clamp(0.15 * edge, 1.3, 2.6));
  stroke_boundary(cairo, mesh, canvas);
  set_color(cairo, kBoxInk);
  cairo_set_line_width(cairo, pixel * kBoxLine);
  stroke_boxes(cairo, options.boxes, canvas);

  cairo_status_t status = cairo_status(cairo);
  if (status == CAIRO_STATUS_SUCCESS && options.format == DrawFormat::kPng)
    status = cairo_surface_write_to_png_stream(surface.get(), write_to_file, &file);
  cairo_surface_finish(surface.get());
  if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(surface.get());
  if (status != CAIRO_STATUS_SUCCESS)
    return fail(ExitCode::kInternal,
                file.target().string() + ": cannot be drawn: " + cairo_status_to_string(status));
  return {};
}

}  // namespace weft::client
