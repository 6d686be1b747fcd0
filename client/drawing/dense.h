// SPDX-License-Identifier: Apache-2.0
// Rasterises a mesh whose triangles are about as small as pixels. Each pixel takes the mean colour
// of the triangles in it; each edge leaves ink along its length, and a pixel with ink i is covered
// to the part 1 - exp(-i), so that edges blend to grey and dense parts get darker without clogging.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "client/drawing/canvas.h"
#include "client/drawing/colors.h"
#include "client/formats/mesh.h"

namespace weft::client {

// Pixels as cairo's RGB24: 0x00RRGGBB, rows from the top.
struct Raster {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<std::uint32_t> pixels;
};

// `palette_index` has one entry of `palette` per triangle; empty: triangles are not coloured.
Raster rasterize(const MeshView& mesh, const Canvas& canvas, const std::vector<Color>& palette,
                 const std::vector<std::uint8_t>& palette_index);

}  // namespace weft::client
