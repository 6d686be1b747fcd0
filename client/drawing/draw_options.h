// SPDX-License-Identifier: Apache-2.0
// What a drawing shows and how large it is.
#pragma once

#include <cstdint>
#include <optional>

namespace weft::client {

enum class DrawColor {
  kAuto,    // by size if the triangles are too small to be seen one by one, otherwise none
  kNone,    // edges alone
  kAngle,   // the smallest angle of each triangle
  kSize,    // its area, logarithmic
  kRegion,  // its region
  kBound,   // its area over its bound, which is given to the drawing
};

// What the coordinates of a mesh are, as far as it is known.
enum class DrawnUnit {
  kNone,     // not known: drawn as they are
  kMetres,   // drawn as they are; lengths have a unit
  kDegrees,  // longitude and latitude: drawn as long as on the ground at the middle latitude, areas
             // and angles are those on the ground
};

// A box in the unit of the mesh: its lower left corner and its sides.
struct DrawnBox {
  double x = 0;
  double y = 0;
  double width = 0;
  double height = 0;
};

struct DrawOptions {
  static constexpr std::uint32_t kMinPixels = 200;
  static constexpr std::uint32_t kMaxPixels = 8192;
  static constexpr std::uint32_t kDefaultPixels = 1800;
  static constexpr std::uint32_t kMaxWorst = 1000;

  DrawColor color = DrawColor::kAuto;
  // The longer side of the mesh in a PNG, or in the image of a dense mesh, kMinPixels to
  // kMaxPixels; pages of SVG and PDF have half as many points. None: kDefaultPixels.
  std::optional<std::uint32_t> pixels{};
  std::optional<DrawnBox> zoom{};        // none: all of the mesh
  std::optional<std::uint32_t> worst{};  // marks so many triangles of the smallest angles
  bool labels = false;                   // numbers of vertices and triangles, and markers
  bool no_legend = false;                // nothing but the mesh
  DrawnUnit unit = DrawnUnit::kNone;     // of the coordinates
};

}  // namespace weft::client
