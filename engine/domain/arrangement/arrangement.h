// SPDX-License-Identifier: Apache-2.0
// The arrangement of a PSLG's segments, triangulated: every crossing, overlap and touching is
// resolved, and the convex hull of all points is covered by a constrained Delaunay triangulation
// whose constrained edges are the pieces of the segments.
//
// How segments meet. All predicates are exact on doubles. With T = merge_tolerance (tolerance.h):
//   - Points nearer to each other than T become one, before anything else (merging.h).
//   - A piece of a segment is led through every vertex nearer than T to its input segment, though
//     earlier ones may have led it up to 2 T away, and through every vertex nearer than half of the
//     least tolerance to it: during its insertion, those that it passes; at the end, those beside
//     the edge (strip_search.h), until none is left. Vertices that are nearer than T to the piece,
//     but not to its input segment, stay beside it: the caller's snap keeps the two apart.
//   - If two pieces cross, the crossing of the two INPUT segments is computed exactly and
//     rounded once; if merging has bent the pieces away from it, that of the pieces. The vertex
//     nearest to the crossing is used if it is nearer than T, otherwise a new vertex is made; both
//     pieces are led through it.
// Afterwards all vertices are T apart, and no constrained edge passes a vertex nearer than half of
// the least tolerance, nor one nearer than T / 2 that is nearer than T to its input segment.
// So a T-junction whose end was rounded is a junction, double walls whose ends are rounded apart
// are one, and nearly concurrent segments meet in one vertex. If segments become one edge, each
// counts in `odd`.
//
// Why that ends. New vertices are T from all others, so only finitely many fit. Between two new
// vertices, each step replaces pieces by strictly shorter ones between existing vertices:
// there are finitely many lengths, so no sequence of such steps is endless. They are shorter
// because a piece uv is led through w only if |uw| and |wv| are below |uv| (`shortens`). For w
// between the ends, T from both, and d < T / 2 off the piece, that is no restriction: with a and b
// the distances of its foot from the ends, b^2 >= T^2 - d^2 > d^2, so |uw|^2 = a^2 + d^2 < (a +
// b)^2. Nor is it for the vertex w nearest to the pieces' own crossing p, at distance r < T: the
// ends are r from p, too, so with e^2 = r^2 - d^2 one of a and b is r + e at least, the other r /
// 2, and d^2 <= r^2 <= 2ab.
//
// Source: the incremental method of triangulation.h, with this merging.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/geometry.h"
#include "engine/domain/arrangement/merging.h"
#include "engine/domain/stop_poller.h"
#include "weft/error.h"
#include "weft/pslg.h"

namespace weft {

// Maximum splits of segments in one PSLG, by crossings and by vertices on them.
inline constexpr std::uint64_t kMaxSplits = std::uint64_t{1} << 25;

struct Arrangement {
  // What lies on a constrained edge.
  struct Constraint {
    std::uint32_t segment = kNone;  // the lowest input segment
    // The first marker that is not 0: of the segments that border no area, then of those that do,
    // in their order.
    std::int32_t marker = 0;
    std::uint32_t marker_segment = kNone;  // the segment of that marker
    bool odd = false;                      // whether an odd number of segments lies here
    std::uint32_t areas = kNone;           // whose border lies here, see AreaJoin
  };

  // A list of areas is the index of an area, kNone if it is empty, or else, from Pslg::areas.size()
  // on, that of a pair of lists in area_joins. So pieces share their lists, however often they are
  // divided.
  struct AreaJoin {
    std::uint32_t first;
    std::uint32_t second;
  };

  struct Triangle {
    std::uint32_t vertex[3];      // counter-clockwise
    std::uint32_t neighbor[3];    // across the edge opposite vertex[i]; kNone on the hull
    std::uint32_t constraint[3];  // on the edge opposite vertex[i], or kNone
  };

  std::vector<Point> vertices;             // input points in their order, then crossings
  std::vector<std::uint32_t> input_point;  // per vertex, kNone for crossings
  std::vector<Triangle> triangles;         // in no particular order
  std::vector<Constraint> constraints;
  std::vector<AreaJoin> area_joins;
  Merging merging;
};

// The error kEmptyDomain of a PSLG of which nothing is left after merging.
Error closed_by_merging(const Merging& merging);

// Bytes that an arrangement of so many vertices and constrained edges takes at the peak: the
// triangulation and the plain copy of it side by side. Measured at a million vertices: 220 per
// vertex without segments, 224 on a ring, 249 and 293 if crossings made the vertices and 1.5 and 2
// edges per vertex are constrained.
std::uint64_t estimated_bytes(std::uint64_t vertices, std::uint64_t edges);

// REQUIRES: a PSLG that `validate` accepts. Throws Stopped: kLimitExceeded over `max_splits`,
// kBudgetExceeded, kCancelled, kDeadlineExceeded, and kEmptyDomain if all points merge onto a line.
Arrangement arrange(const Pslg& pslg, StopPoller& poller, std::uint64_t max_splits = kMaxSplits);

}  // namespace weft
