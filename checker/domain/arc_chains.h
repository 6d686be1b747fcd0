// SPDX-License-Identifier: Apache-2.0
// The chains of edges that a mesh has for the arcs of its domain. Which points of an arc its chain
// passes is the mesher's choice. So the checker takes them from the mesh, judges them by
// themselves (mesh/arc_rules.h), and then judges the mesh by the straight domain in which each arc
// is its chain, as any other.
//
// A chain runs along listed edges with both ends on the arc: no farther from it than kOffArc of its
// extent. If it passes a point of the domain, or a vertex where other listed edges
// meet, that is farther off, or if an end of the arc has been merged, it is no farther off than
// merging allows a segment to be (tolerance.h). An edge with both ends on several arcs or segments
// belongs to the flattest. Where the mesh has no such edges there is a gap (arc_gaps.h), which is
// right where nothing beside it is meshed.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "checker/domain.h"
#include "checker/domain/flattened.h"
#include "checker/edges/listed_edges.h"
#include "checker/geometry/circular_arc.h"
#include "checker/geometry/hull.h"
#include "checker/mesh.h"

namespace weft::check {

inline constexpr double kOffArc = 1e-12;

// No coordinate of the domain's points and arcs is larger, in absolute value: that of an end, with
// the chord, or the chord times the bulge, added. REQUIRES: a domain that judge_domain accepts.
double extent_of(const Domain& domain);

struct ArcChains {
  // An edge of the mesh.
  struct Chord {
    std::uint32_t segment;        // of the given domain: the arc
    std::uint32_t edge;           // listed
    std::uint32_t from, to;       // mesh vertices
    double from_angle, to_angle;  // along the curve
    double turn() const { return to_angle - from_angle; }
    // Its corner is nearer to the chord, by as much as the ends may be off the arc; nullopt if that
    // leaves nothing of it.
    std::optional<Hull> hull;
  };

  // Its points are those of the given domain, then others of the chains. Its merging distance is
  // that of the given one, but at least 2^-40 times the extent of arcs.
  StraightDomain straight;
  std::vector<std::optional<CircularArc>> curves;  // per given segment; nullopt if it is straight
  std::vector<char> is_gap;                        // per segment of the straight domain
  // Per segment of the straight domain: the area between it and its arc (CircularArc::beside).
  std::vector<double> beside;
  double tolerance = 0;  // how far vertices may be off arcs that others bend
  std::vector<Chord> chords;
};

// REQUIRES: a domain that judge_domain accepts; the mesh's structure and conformity.
ArcChains find_arc_chains(const Domain& domain, const Mesh& mesh, const ListedEdges& listed);

}  // namespace weft::check
