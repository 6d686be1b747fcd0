// SPDX-License-Identifier: Apache-2.0
// Judges a Domain by the laws of engine/domain/domain.h, in rational arithmetic of its own.
#pragma once

#include <optional>
#include <string>

#include "engine/domain/domain.h"
#include "weft/pslg.h"

namespace weft {

// The first law that the domain breaks, in words; nothing where it keeps all of them:
// counter-clockwise, neighbours, subsegments, Delaunay, vertices and their input points.
std::optional<std::string> broken_law(const Pslg& pslg, const Domain& domain);

// For domains that carve no segment away: every input segment is a chain of subsegments within
// `ulps` ulps of it.
std::optional<std::string> broken_chain(const Pslg& pslg, const Domain& domain, double ulps = 6);

// For domains whose segments are either apart or within `ulps` ulps: every subsegment lies on a
// segment, and names the lowest of them and the first marker that is not 0.
std::optional<std::string> broken_origin(const Pslg& pslg, const Domain& domain, double ulps = 6);

// For domains that carve nothing away: no two vertices are nearer than the tolerance; no vertex is
// nearer than half of the least one to a subsegment that it is no end of, nor nearer than half of
// the tolerance if it is nearer than that to the segment that the subsegment names; every input
// point is within `reach` tolerances of a vertex, every subsegment within as many of its segment.
std::optional<std::string> broken_separation(const Pslg& pslg, const Domain& domain,
                                             double reach = 1.01);

// Exactly the sum of the triangles' areas, rounded once.
double area(const Domain& domain);

// How many triangles contain p in their interior.
int cover(const Domain& domain, Point p);

// Whether a ray from p crosses the segments an odd number of times. REQUIRES: p is not level with
// any of their ends.
bool odd(const Pslg& pslg, Point p);

}  // namespace weft
