// SPDX-License-Identifier: Apache-2.0
// How large the triangles of a mesh may be.
#pragma once

#include <functional>

#include "files/formats/domain.h"

namespace weft::files {

// That of an equilateral triangle with edges of this length.
inline double area_of_edge(double edge) {
  return 0.4330127018922193 * edge * edge;
}

// The bound on the area of a triangle with this centroid, in squared units of the mesh; not
// positive or not finite: none. Not thread-safe.
using AreaBound = std::function<double(Point)>;
// Makes a bound for one thread. Thread-safe.
using MakeAreaBound = std::function<AreaBound()>;

}  // namespace weft::files
