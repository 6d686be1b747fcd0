// SPDX-License-Identifier: Apache-2.0
#include "client/report/mesh_angles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace weft::client {

AngleRange triangle_angles(const MeshView& mesh, std::size_t triangle) {
  const std::uint32_t* corner = &mesh.triangles[3 * triangle];
  AngleRange range;
  for (int i = 0; i < 3; ++i) {
    const double* a = &mesh.coordinates[2 * std::size_t{corner[i]}];
    const double* b = &mesh.coordinates[2 * std::size_t{corner[(i + 1) % 3]}];
    const double* c = &mesh.coordinates[2 * std::size_t{corner[(i + 2) % 3]}];
    const double ux = b[0] - a[0];
    const double uy = b[1] - a[1];
    const double vx = c[0] - a[0];
    const double vy = c[1] - a[1];
    const double degrees =
        std::atan2(std::abs(ux * vy - uy * vx), ux * vx + uy * vy) * 180 / std::numbers::pi;
    range.min_deg = std::min(range.min_deg, degrees);
    range.max_deg = std::max(range.max_deg, degrees);
  }
  return range;
}

AngleRange mesh_angles(const MeshView& mesh) {
  AngleRange all;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const AngleRange one = triangle_angles(mesh, t);
    all.min_deg = std::min(all.min_deg, one.min_deg);
    all.max_deg = std::max(all.max_deg, one.max_deg);
  }
  return all;
}

}  // namespace weft::client
