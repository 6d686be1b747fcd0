// SPDX-License-Identifier: Apache-2.0
// Which colour each triangle of a drawing has.
#pragma once

#include <cstddef>
#include <vector>

#include "client/drawing/colors.h"
#include "client/drawing/draw.h"
#include "client/formats/mesh.h"

namespace weft::client {

class Coloring {
 public:
  explicit Coloring(DrawColor by);

  // Empty: triangles are not coloured.
  const std::vector<Color>& palette() const { return palette_; }
  // The index of triangle t's colour in the palette. REQUIRES: the palette is not empty.
  std::size_t of(const MeshView& mesh, std::size_t t) const;

 private:
  DrawColor by_;
  std::vector<Color> palette_;
};

}  // namespace weft::client
