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

// One task has all, and all slots are its own: the sequential engine. Costs nothing.
struct OwnsAll {
  static constexpr bool kRestricted = false;
  constexpr bool owns(Point) const { return true; }
  constexpr bool in_core(double, double) const { return true; }
  constexpr bool core_holds(Point, double) const { return true; }
};

// A task has the vertices of a half-open box, beside others. It refines what has its centroid in
// the core, and hands the rest over.
struct OwnsBox {
  static constexpr bool kRestricted = true;
  Box box;
  Box core;  // lies in `box`

  bool owns(Point p) const { return contains(box, p.x, p.y); }
  bool in_core(double x, double y) const { return contains(core, x, y); }
  // Whether all within the root of `reach2` of p lies in the core.
  bool core_holds(Point p, double reach2) const {
    const double room = room_in(core, p);
    return room > 0 && reach2 <= room * room;
  }

  static bool contains(const Box& b, double x, double y) {
    return x >= b.min_x && x < b.max_x && y >= b.min_y && y < b.max_y;
  }
};

}  // namespace weft
