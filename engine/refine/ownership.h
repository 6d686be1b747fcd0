// SPDX-License-Identifier: Apache-2.0
// Which vertices a refinement task may use: a compile-time parameter of the kernel.
//
// The rule: a task reads or writes a triangle only if it owns at least two of its vertices. It
// replaces a triangle only if it owns all three. Of a triangle across the border of a cavity, it
// owns the two common vertices, reads the third, and writes the link to the new neighbour.
// Concurrent tasks own disjoint boxes, and two tasks cannot each own two of three vertices. So at
// any time at most one task may touch a triangle, and the mesh needs no lock and no atomic.
// Vertices move only in equalising and smoothing (vertex_star.h): by a task that owns all vertices
// around, and within the boxes that they are in.
//
// That each insertion is that of the sequential algorithm follows by induction over the moments at
// which cavities are replaced, of all tasks in one order. Let the mesh be constrained Delaunay
// before such a moment. The task has looked only at triangles that no other running task may touch,
// so they are unchanged, and the cavity is that of its point in this mesh: replacing
// it is an insertion by Bowyer-Watson, and the mesh is constrained Delaunay after it. The vertices
// of the cavity's border lie in the task's box; the box is convex, so the point does, too, and all
// new triangles have three vertices of this task. So no other running task sees a change.
//
// In addition, a task that begins checks whether a triangle that migrated to it still exists: only
// in slots that no concurrent task writes (leaf_tasks.h, may_look_at).
#pragma once

#include "engine/base/geometry.h"

namespace weft {

// One task owns all vertices and slots: the sequential engine. Costs nothing.
struct OwnsAll {
  static constexpr bool kRestricted = false;
  constexpr bool owns(Point) const { return true; }
  constexpr bool may_move(Point, Point) const { return true; }
  constexpr bool in_core(double, double) const { return true; }
  constexpr bool core_holds(Point, double) const { return true; }
};

// A task owns the vertices of a half-open box, beside other tasks. It refines triangles with their
// centroid in the core, and lets the others migrate to their own task.
struct OwnsBox {
  static constexpr bool kRestricted = true;
  Box box;
  Box core;  // lies in `box`

  bool owns(Point p) const { return contains(box, p.x, p.y); }
  bool in_core(double x, double y) const { return contains(core, x, y); }
  // Whether the disk around p of squared radius `radius2` lies in the core.
  bool core_holds(Point p, double radius2) const {
    const double room = room_in(core, p);
    return room > 0 && radius2 <= room * room;
  }

  static bool contains(const Box& b, double x, double y) {
    return x >= b.min_x && x < b.max_x && y >= b.min_y && y < b.max_y;
  }
};

}  // namespace weft
