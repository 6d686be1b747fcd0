// SPDX-License-Identifier: Apache-2.0
#include "client/drawing/coloring.h"

#include <cmath>
#include <cstdint>

#include "client/report/mesh_angles.h"

namespace weft::client {
namespace {

constexpr int kAngleSteps = 120;         // half a degree each
constexpr std::int32_t kRegionHues = 8;  // region 0, then the ids modulo the number of colours

}  // namespace

Coloring::Coloring(DrawColor by) : by_(by) {
  if (by_ == DrawColor::kAngle)
    for (int i = 0; i <= kAngleSteps; ++i)
      palette_.push_back(viridis(static_cast<double>(i) / kAngleSteps));
  if (by_ == DrawColor::kRegion)
    for (std::int32_t id = 0; id <= kRegionHues; ++id) palette_.push_back(region_color(id));
}

std::size_t Coloring::of(const MeshView& mesh, std::size_t t) const {
  if (by_ == DrawColor::kAngle)
    return static_cast<std::size_t>(
        std::lround(triangle_angles(mesh, t).min_deg / 60 * kAngleSteps));
  const std::int64_t id = mesh.regions.empty() ? 0 : mesh.regions[t];
  if (id == 0) return 0;
  return static_cast<std::size_t>(((id - 1) % kRegionHues + kRegionHues) % kRegionHues + 1);
}

}  // namespace weft::client
