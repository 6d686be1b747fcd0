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
// The lens. With theta the bound on angles, s = sin(theta):
//     sin(phi)^2 = max(4 s^2, s)    while that is at most 1/2, up to theta = 20.7 degrees,
//     phi = theta                   beyond.
// The first is the least that the proof below needs. The second is Shewchuk's lens, the least
// possible. He deletes the free vertices in the diametral disk before a split, and has a proof up
// to 26.5 degrees; here vertices stay, because the schedule relies on it (parallel/leaf_radius.h).
//
// What is proven. Let theta be at most 20.7 degrees, and all angles between segments at least 90.
// Then refinement ends. Let D be a lower bound on the distance of any two vertices that see each
// other, small against the distances between features of the input and against the root of the
// least size. No insertion makes a smaller distance, so only finitely many fit into the domain:
//   - A point at the standard place for a skinny triangle (steiner_point.h) is at least D / (2 s)
//     from every vertex that it sees, one for a triangle that is too large at least the triangle's
//     circumradius. Another place (petal.h) is taken only if it is at least the triangle's shortest
//     edge away from what it sees, so at least D, and only if the standard one encroaches upon
//     nothing. So only points at standard places split segments: v below is such a point.
//   - Let a piece of length 2R be split at its middle m because a Steiner point v of a skinny
//     triangle t encroached. In the disk of the piece are only vertices of features that do not
//     touch it, and free ones. These were kept out of the lens, so they are at least R tan(phi)
//     from m. (phi <= 45, so this is at most R.)
//   - If v is in the lens, then it is within R / cos(phi) of an end, so R >= cos(phi) D / (2 s),
//     and R tan(phi) >= sin(phi) D / (2 s) >= D.
//   - If v is behind the piece, then so is t's circumcentre. t's circumcircle, of radius
//     r >= D / (2 s), cuts the piece in a chord, and a corner of t is on its arc before the piece.
//     If it is free, it sees the chord at 180 - 2 phi at most, so 2R >= 2 r sin(2 phi), and
//     R tan(phi) >= 2 r sin(phi)^2 >= D. If not, R is at least the distance between features.
//   - A free vertex may lie in the lens if a vertex of another feature, in the lens, too, hid it
//     from the piece. It is above the circle through that vertex and the ends of the piece, so
//     it is at least D times a constant from the point that splits the piece. Such a piece is
//     longer than the distance between the features, so there are finitely many, and D falls at
//     most as often.
// What is observed. Beyond 20.7 degrees, and with angles below 90 (acute_corners.h), nothing is
// proven. Up to 34 degrees everything tried has ended: floor plans with rounded coordinates,
// wedges, stars of 360 rays. At 36, some such plans end at the precision floor, and a star of 200
// rays of unequal lengths does not end. The bound on the number of triangles against the least is
// proven for Ruppert's disk, not for this.
//
// bench/README.md compares this lens with the disk.
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
