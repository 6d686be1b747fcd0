// SPDX-License-Identifier: Apache-2.0
// Draws a mesh into PNG, SVG and PDF files: its edges, the edges on input segments thicker; if
// asked for, its triangles in colours, the worst of them marked, numbers, and boxes over all; below
// it a legend with a scale bar. The page takes the aspect ratio of what is shown.
//
// If the triangles are a few pixels small they are drawn into an image (dense.h), whose pixels show
// the mean size, unless other colours are asked for; in SVG and PDF the image is embedded under a
// boundary of vectors. If more than kMaxVectors triangles are seen, they always are, piece by
// piece while they arrive: only the image and the boundary are kept of them. So memory does not
// grow with the mesh.
//
//   Drawing drawing({.color = DrawColor::kAngle});
//   ... drawing.add(piece) ...
//   if (auto drawn = drawing.draw(DrawFormat::kPng, {}, file); !drawn) return drawn;
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "client/drawing/canvas.h"
#include "client/drawing/draw_options.h"
#include "client/drawing/image.h"
#include "client/drawing/labels.h"
#include "client/drawing/worst_triangles.h"
#include "files/base/atomic_file.h"
#include "files/base/error.h"
#include "files/formats/area_bound.h"
#include "files/formats/mesh.h"

namespace weft::client {

enum class DrawFormat { kPng, kSvg, kPdf };

// The format of an extension, in upper or lower case.
std::optional<DrawFormat> draw_format(const std::filesystem::path& path);

// Places of one kind, which are marked.
struct DrawnMarks {
  std::string meaning;  // for the legend
  std::vector<Point> at;
};

class DenseImage;
class Coloring;
class Legend;

class Drawing {
 public:
  static constexpr std::size_t kMaxVectors = std::size_t{1} << 18;
  // Coordinates beyond it are not drawn.
  static constexpr double kMaxCoordinate = 1e100;

  // `bound` is of the triangles' areas, in square units of the mesh, and is asked by this thread.
  // REQUIRES: it is not empty if the colour is kBound.
  explicit Drawing(const DrawOptions& options, AreaBound bound = {});
  Drawing(const Drawing&) = delete;
  Drawing& operator=(const Drawing&) = delete;
  ~Drawing();

  // Adds the next piece of the mesh: its triangles, their regions (none: all are 0) and its edges,
  // with the coordinates of all vertices so far. Triangles may have either orientation. Without a
  // zoom, all corners of the mesh should be among the vertices before triangle kMaxVectors; what
  // lies outside their box is cut off.
  void add(const MeshView& piece);
  // Puts a ring around each place, with the number of the call, which the legend explains.
  void mark(DrawnMarks marks);
  // What the legend calls regions; those without a name by their number.
  void name_regions(NameTable names) { region_names_ = std::move(names); }
  // Those of which something is shown.
  std::size_t triangles() const { return shown_; }
  // The marked ones, the worst first. Their centroids are in view.
  std::vector<WorstTriangle> worst() const { return worst_.sorted(); }

  // Draws what was added. `boxes` are min x, min y, max x, max y of each, in the unit of the mesh;
  // parts outside the page are cut off. Failures to write stay in the file; other errors:
  // kUnreadableInput for a coordinate beyond kMaxCoordinate; kInternal is cairo's, or there is
  // none.
  Result<void> draw(DrawFormat format, std::span<const double> boxes, OutputFile& file) const;
  // The pixels of a PNG, without boxes. Errors: those of draw.
  Result<Image> image() const;

 private:
  struct Page;

  void see_vertices(std::span<const double> all);
  void add_edges(const MeshView& piece);
  void keep(const DrawnTriangle& triangle);
  void draw_as_image();
  Coloring coloring() const;
  Result<void> check_coordinates() const;
  // What was added, on the surface of cairo that `make_surface` makes of a width and a height.
  template <class MakeSurface>
  auto painted(double pixel, std::span<const double> boxes, const MakeSurface& make_surface) const;
  // Whether the box of the points meets the page.
  bool shows(std::span<const Point> points) const;
  bool is_in_view(const Point& p) const;
  Canvas canvas(double long_side) const;
  double pixels() const { return options_.pixels.value_or(DrawOptions::kDefaultPixels); }
  // The image if there are too many triangles for vectors, or they are too small.
  void draw_mesh(const Page& page) const;
  void draw_marks(const Page& page) const;
  void draw_numbered_marks(const Page& page) const;
  Legend legend(const Page& page) const;

  const DrawOptions options_;
  const AreaBound bound_;
  Extent extent_;  // of the vertices so far
  std::size_t vertices_ = 0;
  std::size_t added_ = 0;
  std::size_t shown_ = 0;
  std::vector<DrawnTriangle> kept_;           // of those shown, while they are few
  std::unique_ptr<Coloring> image_coloring_;  // from then on
  std::unique_ptr<DenseImage> image_;
  std::vector<DrawnEdge> edges_;  // on input segments
  WorstTriangles worst_;
  std::vector<DrawnMarks> marks_;
  NameTable region_names_;
};

}  // namespace weft::client
