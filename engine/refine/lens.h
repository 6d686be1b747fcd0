// SPDX-License-Identifier: Apache-2.0
// The points that encroach upon a piece of a segment, so that the piece is split instead:
//   - a Steiner point of a triangle that is only skinny, in the piece's diametral lens: where the
//     piece is seen at 180 - 2 phi degrees or more (J. R. Shewchuk, "Delaunay refinement algorithms
//     for triangular mesh generation", 2002);
//   - a Steiner point of a triangle that is too large, in the diametral disk, because nothing else
//     keeps it away from the segment;
//   - any Steiner point on the far side of the piece. Then only the piece that hides it from its
//     triangle is split, and none of the others that it encroaches upon.
// Existing vertices encroach upon nothing. So segments are split only for bad triangles, and with
// an angle bound of 0 and no size none is split.
//
// The lens is as wide as the proof of docs/termination.md needs, up to an angle bound of 20.7
// degrees; beyond, it is Shewchuk's, the narrowest possible. bench/README.md compares it with the
// disk.
//
// The mesh is constrained Delaunay, and not conforming Delaunay: the circumdisk of a triangle at a
// segment may hold vertices beyond it. No cavity crosses a segment, so this affects neither the
// ownership of triangles (ownership.h) nor the bound on circumradii (parallel/leaf_radius.h).
//
// Thread-safety: pure functions.
#pragma once

#include <algorithm>

namespace weft {

// Squared cosines of the least angle at which an encroaching point sees the piece.
inline constexpr double kDiametralDisk = 0;
inline constexpr double kNoLens = 2;

// The lens for a bound on angles by its sine, kNoLens for 0. REQUIRES: 0 <= sine <= 1/sqrt(2).
inline double lens_for(double sine) {
  if (sine == 0) return kNoLens;
  const double proven = std::max(4 * sine * sine, sine);
  const double sine2 = proven <= 0.5 ? proven : sine * sine;  // of phi
  const double cosine = 1 - 2 * sine2;                        // of 2 phi
  return cosine * cosine;
}

// Whether the edges a and b from a point make an angle above 90 degrees whose squared cosine is at
// least `lens`.
inline bool in_lens(double ax, double ay, double bx, double by, double lens) {
  const double dot = ax * bx + ay * by;
  return dot < 0 && dot * dot >= lens * ((ax * ax + ay * ay) * (bx * bx + by * by));
}

}  // namespace weft
