// SPDX-License-Identifier: Apache-2.0
// Where two segments cross: computed in exact rational arithmetic, rounded once.
#pragma once

#include "engine/base/geometry.h"

namespace weft {

// The point where the lines ab and cd meet, each coordinate the double nearest to the exact value.
// REQUIRES: the lines are not parallel.
Point crossing_point(Point a, Point b, Point c, Point d);

}  // namespace weft
