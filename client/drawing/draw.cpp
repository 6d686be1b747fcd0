// SPDX-License-Identifier: Apache-2.0
#include "client/drawing/draw.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "client/drawing/cairo_library.h"
#include "client/drawing/clip.h"
#include "client/drawing/coloring.h"
#include "client/drawing/colors.h"
#include "client/drawing/dense.h"
#include "client/drawing/legend.h"
#include "client/drawing/page_text.h"
#include "client/drawing/vectors.h"
#include "files/base/text.h"
#include "files/geo/lonlat_extent.h"

namespace weft::client {
namespace {

struct DestroySurface {
  void operator()(cairo_surface_t* surface) const { loaded_cairo().cairo_surface_destroy(surface); }
};
struct DestroyContext {
  void operator()(cairo_t* context) const { loaded_cairo().cairo_destroy(context); }
};
using Surface = std::unique_ptr<cairo_surface_t, DestroySurface>;
using Context = std::unique_ptr<cairo_t, DestroyContext>;

// What was drawn on, and whether that failed.
struct Painted {
  Surface surface;
  cairo_status_t status = CAIRO_STATUS_SUCCESS;
};

constexpr double kMarginsPerSide = 60;
constexpr double kEmsPerSide = 66;
constexpr double kDenseEdge = 5;  // pixels
constexpr double kBoxLine = 1.5;

cairo_status_t write_to_file(void* file, const unsigned char* bytes, unsigned size) {
  static_cast<OutputFile*>(file)->write(bytes, size);
  return CAIRO_STATUS_SUCCESS;  // the file keeps its failure
}

Surface make_image(double width, double height) {
  return Surface(loaded_cairo().cairo_image_surface_create(
      CAIRO_FORMAT_RGB24, static_cast<int>(width), static_cast<int>(height)));
}

Surface make_surface(DrawFormat format, double width, double height, OutputFile& file) {
  switch (format) {
    case DrawFormat::kPng:
      return make_image(width, height);
    case DrawFormat::kSvg:
      return Surface(
          loaded_cairo().cairo_svg_surface_create_for_stream(write_to_file, &file, width, height));
    case DrawFormat::kPdf:
      break;
  }
  return Surface(
      loaded_cairo().cairo_pdf_surface_create_for_stream(write_to_file, &file, width, height));
}

void draw_image(cairo_t* cairo, Image image, const Canvas& canvas) {
  const Surface surface(loaded_cairo().cairo_image_surface_create_for_data(
      reinterpret_cast<unsigned char*>(image.pixels.data()), CAIRO_FORMAT_RGB24,
      static_cast<int>(image.width), static_cast<int>(image.height),
      static_cast<int>(image.width * sizeof(std::uint32_t))));
  loaded_cairo().cairo_save(cairo);
  loaded_cairo().cairo_scale(cairo, canvas.width() / static_cast<double>(image.width),
                             canvas.height() / static_cast<double>(image.height));
  loaded_cairo().cairo_set_source_surface(cairo, surface.get(), 0, 0);
  loaded_cairo().cairo_paint(cairo);
  loaded_cairo().cairo_restore(cairo);
  loaded_cairo().cairo_surface_flush(loaded_cairo().cairo_get_target(cairo));
}

// Counter-clockwise, whatever the order in the piece.
DrawnTriangle triangle_of(const MeshView& piece, std::size_t t) {
  DrawnTriangle triangle;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t v = piece.triangles[3 * t + k];
    triangle.vertices[k] = static_cast<std::uint32_t>(v);
    triangle.corners[k] = {piece.coordinates[2 * v], piece.coordinates[2 * v + 1]};
  }
  auto& p = triangle.corners;
  if ((p[1].x - p[0].x) * (p[2].y - p[0].y) < (p[1].y - p[0].y) * (p[2].x - p[0].x)) {
    std::swap(p[1], p[2]);
    std::swap(triangle.vertices[1], triangle.vertices[2]);
  }
  if (!piece.regions.empty()) triangle.region = piece.regions[t];
  return triangle;
}

Extent extent_of(const DrawnBox& box) {
  Extent extent;
  extent.add(std::array{box.x, box.y, box.x + box.width, box.y + box.height});
  return extent;
}

}  // namespace

// One page while it is drawn. Lengths in cairo are in its units; `pixel` of them are a pixel of a
// PNG.
struct Drawing::Page {
  cairo_t* cairo = nullptr;
  Canvas canvas;
  double pixel = 1;
  double em = 0;
  double mean_edge = 0;                // pixels
  bool dense = false;                  // drawn as an image
  const DenseImage* image = nullptr;   // if dense
  const Coloring* coloring = nullptr;  // null: none
};

Drawing::Drawing(const DrawOptions& options, AreaBound bound)
    : options_(options),
      bound_(std::move(bound)),
      worst_(options.worst.value_or(0), options.unit) {}

Drawing::~Drawing() = default;

Canvas Drawing::canvas(double long_side) const {
  const Extent shown = options_.zoom ? extent_of(*options_.zoom) : extent_;
  const double x_scale = options_.unit == DrawnUnit::kDegrees && !shown.empty()
                             ? longitude_scale((shown.min_y + shown.max_y) / 2)
                             : 1;
  return {shown, long_side, long_side / kMarginsPerSide, x_scale};
}

void Drawing::see_vertices(std::span<const double> all) {
  extent_.add(all.subspan(2 * vertices_));
  vertices_ = all.size() / 2;
}

bool Drawing::shows(std::span<const Point> points) const {
  if (!options_.zoom) return true;
  const DrawnBox& box = *options_.zoom;
  // With the margin of the page, whose sides may differ.
  const double margin = std::max(box.width, box.height) / kMarginsPerSide * 2;
  const auto [left, right] = std::minmax_element(
      points.begin(), points.end(), [](const Point& a, const Point& b) { return a.x < b.x; });
  const auto [low, high] = std::minmax_element(
      points.begin(), points.end(), [](const Point& a, const Point& b) { return a.y < b.y; });
  return right->x >= box.x - margin && left->x <= box.x + box.width + margin &&
         high->y >= box.y - margin && low->y <= box.y + box.height + margin;
}

bool Drawing::is_in_view(const Point& p) const {
  if (!options_.zoom) return true;
  const DrawnBox& box = *options_.zoom;
  return p.x >= box.x && p.x <= box.x + box.width && p.y >= box.y && p.y <= box.y + box.height;
}

void Drawing::add_edges(const MeshView& piece) {
  const auto at = [&](std::size_t v) {
    return Point{piece.coordinates[2 * v], piece.coordinates[2 * v + 1]};
  };
  for (std::size_t e = 0; e < piece.edge_count(); ++e) {
    const std::array<Point, 2> ends = {at(piece.edges[2 * e]), at(piece.edges[2 * e + 1])};
    if (shows(ends))
      edges_.push_back({ends[0], ends[1], piece.edge_markers.empty() ? 0 : piece.edge_markers[e]});
  }
}

// For kAuto, the colouring of triangles that are too small to be seen.
Coloring Drawing::coloring() const {
  return {options_.color == DrawColor::kAuto ? DrawColor::kSize : options_.color, options_.unit,
          bound_};
}

void Drawing::draw_as_image() {
  image_coloring_ = std::make_unique<Coloring>(coloring());
  image_ = std::make_unique<DenseImage>(canvas(pixels()), *image_coloring_);
  for (const DrawnTriangle& triangle : kept_) image_->add(triangle);
  kept_ = {};
}

void Drawing::keep(const DrawnTriangle& triangle) {
  if (kept_.size() < kMaxVectors) return kept_.push_back(triangle);
  draw_as_image();
  image_->add(triangle);
}

void Drawing::add(const MeshView& piece) {
  see_vertices(piece.coordinates);
  add_edges(piece);
  for (std::size_t t = 0; t < piece.triangle_count(); ++t) {
    DrawnTriangle triangle = triangle_of(piece, t);
    triangle.id = added_++;
    if (!shows(triangle.corners)) continue;
    ++shown_;
    if (is_in_view(centroid(triangle))) worst_.add(triangle);
    image_ ? image_->add(triangle) : keep(triangle);
  }
}

void Drawing::mark(DrawnMarks marks) {
  for (const Point& p : marks.at) extent_.add(std::array{p.x, p.y});
  marks_.push_back(std::move(marks));
}

void Drawing::draw_mesh(const Page& page) const {
  cairo_t* const cairo = page.cairo;
  Vectors vectors(cairo, page.canvas, page.pixel);
  if (page.dense) {
    draw_image(cairo, page.image->image(), page.canvas);
  } else {
    if (page.coloring != nullptr) vectors.fill(kept_, *page.coloring);
    vectors.stroke_inner_edges(kept_, page.coloring != nullptr);
  }
  const double width = std::clamp(0.15 * page.mean_edge, 1.3, 2.6);
  edges_.empty() && !page.dense ? vectors.stroke_outline(kept_, width)
                                : vectors.stroke_edges(edges_, width);
}

void Drawing::draw_marks(const Page& page) const {
  const double height = 0.7 * page.em;
  if (options_.labels && !page.dense) put_labels(page.cairo, page.canvas, kept_, edges_, height);
  const std::vector<WorstTriangle> worst = worst_.sorted();
  constexpr std::size_t kMaxNumbered = 30;
  for (std::size_t i = worst.size(); i-- > 0;) {  // the worst is drawn last, on top
    const PagePoint at = page.canvas.at(centroid(worst[i].triangle));
    double radius = 0.5 * page.em;
    for (const Point& corner : worst[i].triangle.corners) {
      const PagePoint p = page.canvas.at(corner);
      radius = std::max(radius, 1.1 * std::hypot(p.x - at.x, p.y - at.y));
    }
    radius = std::min(radius, 4 * page.em);
    put_mark(page.cairo, at, radius, 0.1 * page.em);
    if (worst.size() <= kMaxNumbered)
      put_text(page.cairo, {at.x + 0.75 * radius + 0.1 * page.em, at.y - 0.75 * radius},
               std::to_string(i + 1), {.height = 0.8 * page.em, .halo = true, .color = kMarkInk});
  }
}

void Drawing::draw_numbered_marks(const Page& page) const {
  const double radius = 0.6 * page.em;
  for (std::size_t kind = 0; kind < marks_.size(); ++kind)
    for (const Point& p : marks_[kind].at) {
      if (!is_in_view(p)) continue;
      const PagePoint at = page.canvas.at(p);
      put_mark(page.cairo, at, radius, 0.12 * page.em, mark_color(kind));
      const std::string number = std::to_string(kind + 1);
      const TextStyle style{.height = 0.8 * page.em, .halo = true, .color = mark_color(kind)};
      const double width = text_width(number, style.height);
      const bool fits_right = at.x + radius + width < page.canvas.width();
      const bool fits_above = at.y - radius - style.height > 0;
      put_text(page.cairo,
               {fits_right ? at.x + 0.8 * radius : at.x - 0.8 * radius - width,
                fits_above ? at.y - 0.8 * radius : at.y + 0.8 * (radius + style.height)},
               number, style);
    }
}

Legend Drawing::legend(const Page& page) const {
  Legend legend(page.em);
  if (options_.no_legend) return legend;
  if (!extent_.empty()) {
    const double metres = options_.unit == DrawnUnit::kDegrees ? kMetresPerDegree : 1;
    constexpr double kOfTheWidth = 0.2;
    legend.add_scale_bar(page.canvas.scale() / metres,
                         std::clamp(kOfTheWidth * page.canvas.width(), 5 * page.em, 14 * page.em),
                         options_.unit);
  }
  if (added_ > 0 || marks_.empty())
    legend.add_text((shown_ < added_ ? with_separators(shown_) + " of " : "") +
                    with_separators(added_) + (added_ == 1 ? " triangle" : " triangles"));
  if (page.coloring != nullptr)
    legend.add_colors(*page.coloring, options_.unit, page.dense, region_names_);
  if (const auto worst = worst_.sorted(); !worst.empty()) {
    const std::string least = number_text(worst.front().angle_deg) + "\u00b0";
    const std::string most = number_text(worst.back().angle_deg) + "\u00b0";
    legend.add_mark((worst.size() == 1 ? "smallest angle, "
                                       : with_separators(worst.size()) + " smallest angles, ") +
                    (least == most ? least : least + " to " + most));
  }
  for (std::size_t kind = 0; kind < marks_.size(); ++kind)
    legend.add_mark(std::to_string(kind + 1) + " " + marks_[kind].meaning, mark_color(kind));
  if (options_.labels && !page.dense)
    legend.add_text("numbers of vertices black, of triangles blue, markers other than 0 red");
  return legend;
}

Result<void> Drawing::check_coordinates() const {
  for (const double bound : {extent_.min_x, extent_.min_y, extent_.max_x, extent_.max_y})
    if (!extent_.empty() && !(std::abs(bound) <= kMaxCoordinate))
      return fail(ExitCode::kUnreadableInput, "the mesh has a coordinate of " + shortest(bound) +
                                                  ", drawings go to " + shortest(kMaxCoordinate));
  return {};
}

template <class MakeSurface>
auto Drawing::painted(double pixel, std::span<const double> boxes,
                      const MakeSurface& make_surface) const {
  Page page{.canvas = canvas(pixels() * pixel), .pixel = pixel};
  page.em = pixels() * pixel / kEmsPerSide;

  Coloring colors = coloring();
  std::unique_ptr<DenseImage> image;
  page.mean_edge = image_ ? image_->mean_edge() : mean_inner_edge(kept_, page.canvas) / pixel;
  page.dense = image_ != nullptr || (page.mean_edge < kDenseEdge && !kept_.empty());
  page.coloring = image_ ? image_coloring_.get() : &colors;
  if (page.dense && !image_) {
    image = std::make_unique<DenseImage>(canvas(pixels()), colors);
    for (const DrawnTriangle& triangle : kept_) image->add(triangle);
  } else if (!page.dense) {
    note_all(kept_, page.canvas, colors);
  }
  page.image = image_ ? image_.get() : image.get();
  if (page.coloring->by() == DrawColor::kNone ||
      (options_.color == DrawColor::kAuto && !page.dense))
    page.coloring = nullptr;

  const Legend below = legend(page);
  const double side = pixels() * pixel / kMarginsPerSide;
  const double width = std::max(page.canvas.width(), std::ceil(below.least_width() + 2 * side));
  const double height = page.canvas.height() + std::ceil(below.height(width - 2 * side));
  Surface surface = make_surface(width, height);
  const Context context(loaded_cairo().cairo_create(surface.get()));
  cairo_t* const cairo = page.cairo = context.get();
  set_color(cairo, kPaper);
  loaded_cairo().cairo_paint(cairo);
  loaded_cairo().cairo_set_line_cap(cairo, CAIRO_LINE_CAP_ROUND);

  loaded_cairo().cairo_save(cairo);
  loaded_cairo().cairo_translate(cairo, std::floor((width - page.canvas.width()) / 2), 0);
  loaded_cairo().cairo_rectangle(cairo, 0, 0, page.canvas.width(), page.canvas.height());
  loaded_cairo().cairo_clip(cairo);
  draw_mesh(page);
  Vectors(cairo, page.canvas, pixel).stroke_boxes(boxes, kBoxLine);
  draw_marks(page);
  draw_numbered_marks(page);
  loaded_cairo().cairo_restore(cairo);
  below.draw(cairo, {side, page.canvas.height()}, width - 2 * side);
  return Painted{std::move(surface), loaded_cairo().cairo_status(cairo)};
}

Result<void> Drawing::draw(DrawFormat format, std::span<const double> boxes,
                           OutputFile& file) const {
  if (auto drawable = check_coordinates(); !drawable) return drawable;
  if (auto loaded = load_cairo(); !loaded) return loaded;
  const auto [surface, painting] = painted(
      format == DrawFormat::kPng ? 1 : 0.5, boxes,
      [&](double width, double height) { return make_surface(format, width, height, file); });
  cairo_status_t status = painting;
  if (status == CAIRO_STATUS_SUCCESS && format == DrawFormat::kPng)
    status = loaded_cairo().cairo_surface_write_to_png_stream(surface.get(), write_to_file, &file);
  loaded_cairo().cairo_surface_finish(surface.get());
  if (status == CAIRO_STATUS_SUCCESS) status = loaded_cairo().cairo_surface_status(surface.get());
  if (status != CAIRO_STATUS_SUCCESS)
    return fail(ExitCode::kInternal, file.target().string() + ": cannot be drawn: " +
                                         loaded_cairo().cairo_status_to_string(status));
  return {};
}

Result<Image> Drawing::image() const {
  if (auto drawable = check_coordinates(); !drawable) return tl::unexpected(drawable.error());
  if (auto loaded = load_cairo(); !loaded) return tl::unexpected(loaded.error());
  const auto [surface, status] = painted(1, {}, make_image);
  loaded_cairo().cairo_surface_flush(surface.get());
  if (status != CAIRO_STATUS_SUCCESS)
    return fail(ExitCode::kInternal, std::string("the mesh cannot be drawn: ") +
                                         loaded_cairo().cairo_status_to_string(status));
  Image image;
  image.width =
      static_cast<std::size_t>(loaded_cairo().cairo_image_surface_get_width(surface.get()));
  image.height =
      static_cast<std::size_t>(loaded_cairo().cairo_image_surface_get_height(surface.get()));
  const unsigned char* row = loaded_cairo().cairo_image_surface_get_data(surface.get());
  for (std::size_t y = 0; y < image.height; ++y) {
    const auto* const pixels = reinterpret_cast<const std::uint32_t*>(row);
    image.pixels.insert(image.pixels.end(), pixels, pixels + image.width);
    row += loaded_cairo().cairo_image_surface_get_stride(surface.get());
  }
  return image;
}

}  // namespace weft::client
