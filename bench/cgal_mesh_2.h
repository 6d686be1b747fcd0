// SPDX-License-Identifier: GPL-3.0-or-later
// CGAL's mesher (Mesh_2) under the same bounds as ours, for comparison.
//
// This folder has more than 25 files because it is one program, with a file pair for each
// measurement, beside the scripts that measure other meshers and clients.
#pragma once

#include <cstdint>
#include <functional>

#include "weft/pslg.h"

namespace weft::bench {

struct CgalResult {
  std::uint64_t triangles = 0;
  double seconds = 0;  // of the refinement, the triangulation left out
};

// Delaunay_mesher_2 with a criterion that asks for area <= size(centroid) and the minimum angle.
// `size` is compiled in, where ours comes as text.
CgalResult refine_with_cgal(const Pslg& pslg, const std::function<double(double, double)>& size,
                            double min_angle_deg);

}  // namespace weft::bench
