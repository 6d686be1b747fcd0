// SPDX-License-Identifier: Apache-2.0
// Draws a mesh into PNG, SVG and PDF files: its edges, the edges on input segments thicker, and, if
// asked for, the triangles coloured by their smallest angle (0 dark to 60 degrees bright) or by
// region, and boxes over all. The page takes the aspect ratio of the mesh.
//
// Meshes whose triangles are a few pixels small are drawn into an image (dense.h), so that edges
// blend to grey by their density; in SVG and PDF the image is embedded under a boundary of vectors.
// A mesh of more than kMostVectors triangles always is, piece by piece while it arrives: only the
// image and the boundary are kept of it. So memory does not grow with the mesh.
//
//   Drawing drawing(DrawColor::kAngle);
//   ... drawing.add(piece) ...
//   if (auto drawn = drawing.draw(DrawFormat::kPng, {}, file); !drawn) return drawn;
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "client/base/atomic_file.h"
#include "client/base/error.h"
#include "client/drawing/canvas.h"
#include "client/formats/mesh.h"

// Of cairo.
typedef struct _cairo cairo_t;

namespace weft::client {

enum class DrawFormat { kPng, kSvg, kPdf };
enum class DrawColor { kNone, kAngle, kRegion };

// The format of an extension, in upper or lower case.
std::optional<DrawFormat> draw_format(const std::filesystem::path& path);

class DenseImage;
class Coloring;

class Drawing {
 public:
  static constexpr std::size_t kMostVectors = std::size_t{1} << 19;

  // `long_side` is in pixels of a PNG, or of the image of a dense mesh; pages of SVG and PDF have
  // half as many points.
  explicit Drawing(DrawColor color, double long_side = 1800);
  Drawing(const Drawing&) = delete;
  Drawing& operator=(const Drawing&) = delete;
  ~Drawing();

  // Adds the next piece of the mesh: its triangles, their regions (none: all are 0) and its edges,
  // with the coordinates of all vertices so far. All corners of the mesh should be among the
  // vertices before triangle kMostVectors; points outside their box are put on the margin.
  void add(const MeshView& piece);
  std::size_t triangles() const { return triangles_; }

  // Draws what was added. `boxes` are min x, min y, max x, max y of each, in the unit of the mesh;
  // parts outside the page are cut off. Failures to write stay in the file; an error (kInternal) is
  // cairo's.
  Result<void> draw(DrawFormat format, std::span<const double> boxes, OutputFile& file) const;

 private:
  void keep(const MeshView& piece);
  void draw_as_image();
  Canvas canvas(double long_side) const;
  void fill_triangles(cairo_t* cairo, const Canvas& canvas) const;
  void stroke_inner_edges(cairo_t* cairo, const Canvas& canvas) const;
  void stroke_boundary(cairo_t* cairo, const Canvas& canvas) const;

  const std::unique_ptr<const Coloring> coloring_;
  const double long_side_;
  std::size_t triangles_ = 0;
  Extent extent_;
  Mesh mesh_;                          // while it is small; without edges
  std::unique_ptr<DenseImage> image_;  // from then on
  std::vector<double> boundary_;       // x, y of both ends of each edge on an input segment
};

}  // namespace weft::client
