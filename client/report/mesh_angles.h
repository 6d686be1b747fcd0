// SPDX-License-Identifier: Apache-2.0
// Angles of triangles.
#pragma once

#include <cstddef>
#include <cstdint>

#include "client/base/files.h"
#include "files/formats/mesh.h"

namespace weft::client {

struct AngleRange {
  double min_deg = 180;
  double max_deg = 0;
};

// The angles of one triangle. A degenerate one has 0 and 180.
AngleRange triangle_angles(const MeshView& mesh, std::size_t triangle);

// The angles of all triangles.
AngleRange mesh_angles(const MeshView& mesh);

}  // namespace weft::client
