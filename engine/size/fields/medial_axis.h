// SPDX-License-Identifier: Apache-2.0
// The medial axis of the meshed area, pruned: the centres of the largest disks in it, less those
// that only the unevenness of one bank makes.
//
//   Result<MedialAxis> axis = medial_axis(domain, context);
//
// Walls are the edges that have the meshed area on one side. Edges that have it on both sides are
// none, whatever their marker or region; nor are points inside.
//
// A centre counts if its disk touches walls in two places that it sees at least kObjectAngle apart.
// The largest disk of any face touches walls 2 pi / 3 apart at least, so that every component of
// the meshed area has an axis. With an angle of 1.05, an unevenness of 5 % of the width makes
// centres of its own; with pi, only places where the walls are parallel would count.
//
// How. The centres are approximated by those of the circles of a constrained Delaunay triangulation
// of the walls alone. A wall is halved if its square is more than the area of a triangle of the
// axis that stands on it, or if it is seen under more than kObjectAngle / 2 from the tip of
// another one. A corner is cut by an ear, a triangle with two walls, which makes no centre. If the
// corner is sharper than pi - kObjectAngle, the axis enters it, but no nearer to the tip than half
// the shorter of its two walls: a corner is no passage, and a size by the width would have no end
// there. No wall shorter than a share of the perimeter is halved: so the number of pieces is
// bounded, whatever the shape. The share is one of 2 walls + 2^17, or of 64 walls + 2^13 if that
// is less: a domain of a few walls with a needle between them took 1.2 s, which are .06 s. If a
// passage is too narrow for that, its axis is the line through the middles of the edges that cross
// it; if a whole component is, the centre of the largest disk in one of its triangles.
//
// Sources. Disks from Delaunay circles: N. Amenta, S. Choi, R. Kolluri, "The power crust", 2001;
// the angle: D. Attali, A. Montanvert, "Computing and simplifying 2D and 3D continuous skeletons",
// 1997; middles of edges: L. Prasad, "Morphological analysis of shapes", 1997.
#pragma once

#include <vector>

#include "engine/base/context.h"
#include "engine/domain/domain.h"
#include "engine/size/fields/distance_field.h"
#include "weft/error.h"

namespace weft {

inline constexpr double kObjectAngle = 2;  // radians

struct MedialAxis {
  std::vector<Line> walls;
  std::vector<Line> axis;  // at least one; those of length 0 are points
};

// Errors: kCancelled, kDeadlineExceeded; kBudgetExceeded, kOutOfMemory for about 300 bytes for each
// wall and each of the pieces that they are halved into. Never throws. One thread; the result
// depends on the domain alone. REQUIRES: a domain that `triangulate` made.
Result<MedialAxis> medial_axis(const Domain& domain, const ExecutionContext& context);

}  // namespace weft
