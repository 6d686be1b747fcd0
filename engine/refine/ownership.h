// SPDX-License-Identifier: GPL-3.0-or-later
// Which vertices a refinement task may use: a compile-time parameter of the kernel.
//
// The rule: a triangle may be modified only by a task that owns its three vertices, and read only
// when reached across an edge whose two ends are owned. Concurrent tasks own disjoint boxes, and
// vertices never move. So two concurrent cavities share no triangle (its vertices would have two
// owners) and their boundaries share no edge; by Corollary 1 of the paper their points are
// Delaunay-independent, and the mesh needs no lock and no atomic.
#pragma once

#include "engine/geometry.h"

namespace weft {

// One task has all: the sequential engine. Costs nothing.
struct OwnsAll {
  static constexpr bool kRestricted = false;
  constexpr bool owns(Point) const { return true; }
};

// A task has the vertices of a half-open box.
struct OwnsBox {
  static constexpr bool kRestricted = true;
  Box box;
  bool owns(Point p) const {
    return p.x >= box.min_x && p.x < box.max_x && p.y >= box.min_y && p.y < box.max_y;
  }
};

}  // namespace weft
