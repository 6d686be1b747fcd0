// SPDX-License-Identifier: Apache-2.0
// Draws a mesh into a PNG, SVG or PDF file: its edges, the edges on input segments thicker, and, if
// asked for, the triangles coloured by their smallest angle (0 dark to 60 degrees bright) or by
// region, and boxes over all. The page takes the aspect ratio of the mesh.
//
// Meshes whose triangles are a few pixels small are rasterised (dense.h), so that edges blend to
// grey by their density; in SVG and PDF the raster is embedded under a boundary of vectors.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "client/atomic_file.h"
#include "client/error.h"
#include "client/formats/mesh.h"

namespace weft::client {

enum class DrawFormat { kPng, kSvg, kPdf };
enum class DrawColor { kNone, kAngle, kRegion };

// By extension, in any case.
std::optional<DrawFormat> draw_format(const std::filesystem::path& path);

struct DrawOptions {
  DrawFormat format = DrawFormat::kPng;
  DrawColor color = DrawColor::kNone;
  // Pixels of a PNG, or of the raster of a dense mesh; pages of SVG and PDF have half as many
  // points.
  double long_side = 1800;
  // min x, min y, max x, max y of each, in the unit of the mesh; what lies off the page is cut off.
  std::span<const double> boxes = {};
};

// Failures to write stay in the file; an error (kInternal) is cairo's.
Result<void> draw(const MeshView& mesh, const DrawOptions& options, OutputFile& file);

}  // namespace weft::client
