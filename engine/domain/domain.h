// SPDX-License-Identifier: Apache-2.0
// The domain: the constrained Delaunay triangulation (CDT) of a PSLG, holes carved, regions
// flooded, the outside removed. It is what refinement starts from.
//
//   Result<Domain> domain = triangulate(pslg, context);
//
// Crossings and near misses. Predicates are exact on doubles; the crossing of two input segments
// is computed exactly and rounded once, and both are led through the rounded point. Features nearer
// than one tolerance are merged (tolerance.h, arrangement.h): so a T-junction whose end was rounded
// still is a junction, and several segments that nearly meet in one point do meet in one. "Lies on"
// below means: within that tolerance, or a few times it if dozens of segments nearly meet.
//
// Laws that a Domain obeys (checked by tests):
//   - every triangle is counter-clockwise and refers to three distinct vertices;
//   - triangles[t].neighbor[i] shares the edge opposite vertex[i], and names t back;
//   - an edge carries a subsegment iff it lies on an input segment; every edge without a neighbour
//     carries one;
//   - every edge without a subsegment is Delaunay;
//   - every input segment inside is a chain of subsegments;
//   - every vertex belongs to a triangle; no two vertices coincide; those that are input points
//     come first, in their order, then the crossings;
//   - the vertices of triangles with near numbers are near: triangles follow a Hilbert curve;
//   - the result depends on the PSLG alone: the same bits on every run and machine.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "engine/base/context.h"
#include "engine/base/geometry.h"
#include "engine/domain/arrangement/merging.h"
#include "weft/error.h"
#include "weft/mesh.h"
#include "weft/pslg.h"

namespace weft {

// A piece of an input segment between two vertices of the CDT.
struct Subsegment {
  std::uint32_t a = 0;  // index into Domain::vertices
  std::uint32_t b = 0;
  std::uint32_t segment = 0;  // index into Pslg::segments; the lowest if several overlap
  std::int32_t marker = 0;  // the first that is not 0 of those that overlap, borders of areas last
};

// Faces of the arrangement that a region seed flooded, or that areas give this id and this bound.
// Region 0 is the rest: id 0, no bound.
struct Region {
  std::int32_t id = 0;
  double max_area = std::numeric_limits<double>::infinity();
};

struct Domain {
  struct Triangle {
    std::uint32_t vertex[3];      // counter-clockwise
    std::uint32_t neighbor[3];    // across the edge opposite vertex[i]; kNone outside
    std::uint32_t subsegment[3];  // on the edge opposite vertex[i], or kNone
    std::uint32_t region;         // index into Domain::regions
  };

  std::vector<Point> vertices;
  std::vector<std::uint32_t> input_point;  // per vertex: its index in Pslg::points (the lowest of
                                           // the coincident ones), or kNone if segments cross
  std::vector<Triangle> triangles;
  std::vector<Subsegment> subsegments;
  // Per subsegment, of its arc from a to b: 1 over the radius, above 0 if it turns left; empty if
  // all are straight.
  std::vector<double> curvatures;
  std::vector<Region> regions;  // regions[0] is the default region
  Merging merging;
  Overlap overlap;
  OutsideSegments outside;

  std::uint64_t bytes() const {
    return vertices.capacity() * sizeof(Point) + input_point.capacity() * sizeof(std::uint32_t) +
           triangles.capacity() * sizeof(Triangle) + subsegments.capacity() * sizeof(Subsegment) +
           curvatures.capacity() * sizeof(double);
  }
};

// By how much a piece of an arc turns.
inline constexpr double kMaxTurnDeg = 60;

// Validates the PSLG and triangulates it. Arcs are cut into pieces that turn by at most
// `max_turn_deg`, and as much further as it takes to keep them apart (arcs/chords.h). A segment
// whose ends are the same point is that point, as rounding leaves many. If several seeds flood a
// face, the last one wins.
//
// Errors, each naming the first offender:
//   kBadCoordinate      domain.points[i].x or .y, the same of domain.holes[i], domain.regions[i]
//   kIndexOutOfRange    domain.segments[i].a or .b, domain.segment_areas[i], domain.arcs[i]
//   kBadOption          domain.regions[i].max_area, domain.areas[i].max_area: not finite or not
//                       above 0; domain.areas[i]: its segments do not close to rings; domain.snap:
//                       not finite or below 0; domain.arcs[i]: its bulge, a second arc of one
//                       segment, or one that ends at the point where it begins; domain.segments[i]:
//                       its arc is too near to something to be kept apart from it, or merging has
//                       led it through another vertex
//   kTooFewPoints, kCollinearPoints                domain.points
//   kSeedOutsideDomain, kSeedOnSegment             domain.holes[i], domain.regions[i]
//   kEmptyDomain        domain.segments if no face is enclosed, domain.holes[i] if they carve
//                       everything away, domain.areas if they leave nothing
//   kLimitExceeded      domain.points, domain.segments: more than can be numbered, or more than
//                       2^25 crossings, overlaps and touchings (arrangement.h)
//   kBudgetExceeded     240 bytes a vertex and 40 a subsegment, about the peak, are over
//                       Budget::max_bytes
//   kOutOfMemory        the machine has none left
//   kCancelled, kDeadlineExceeded  noticed within 50 ms at a million points; freeing their memory
//                       takes some 20 ms more
//
// Never throws. Thread-safe: calls share nothing.
//
// About 1 s for a million random points, 4 ms for a coast line of 9,370 (one core of 2023).
Result<Domain> triangulate(const Pslg& pslg, const ExecutionContext& context,
                           double max_turn_deg = kMaxTurnDeg);

}  // namespace weft
