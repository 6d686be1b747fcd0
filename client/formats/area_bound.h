// SPDX-License-Identifier: Apache-2.0
// How large the triangles of a mesh may be.
#pragma once

#include <functional>

#include "client/formats/domain.h"

namespace weft::client {

// The bound on the area of a triangle with this centroid, in squared units of the mesh; not
// positive or not finite: none. Not thread-safe.
using AreaBound = std::function<double(Point)>;
// Makes a bound for one thread. Thread-safe.
using MakeAreaBound = std::function<AreaBound()>;

}  // namespace weft::client
