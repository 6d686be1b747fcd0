// SPDX-License-Identifier: Apache-2.0
// Makes a domain no finer than its mesh needs: features smaller than a share of the size at their
// place go, so that no edge of the mesh has to be shorter because of them.
//
//   Result<Simplified> made = simplify(domain, finest, context);
//   made->domain; made->changes.points;
//
// Steps, until nothing is narrow any more, five times at most:
//   1. rings that enclose less than the finest triangle are dropped (decimation.h);
//   2. nodes of lines are taken out where lines are shorter than the finest length (decimation.h);
//   3. inlets, channels and spits that are narrower are closed or opened, and small waters behind
//      closed channels dropped (narrow.h).
// Then pinches are opened (pinches.h). Other corners do not move: those that stay are points of the
// original, but where a narrow place was closed between two of them.
//
// Laws that the result obeys (checked by tests):
//   - no point of a line is farther from the original's lines than Simplification::farthest, nor
//     than the finest length there;
//   - what is farther from the original's lines than the finest length is meshed, with the same
//     region, if and only if it was, but for waters behind closed channels: each of them encloses
//     less than kLarge of the finest triangles (straits.h), and holds nothing that stays;
//   - what is left of what was connected is connected: a strait to a large water stays narrow;
//   - the border passes no point twice, unless lines of the original met there;
//   - lines meet where they met: junctions, ends of markers and of lines, and points that no line
//     names stay;
//   - the result depends on the domain and the wish alone: the same bits on every run and machine.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "engine/base/context.h"
#include "engine/base/geometry.h"
#include "engine/domain/domain.h"
#include "weft/error.h"
#include "weft/mesh.h"

namespace weft {

// How fine a domain may be. All lengths are those of edges, in the unit of the points.
struct Finest {
  double share = 0;                   // of the length that edges should have. REQUIRES: > 0
  std::function<double(Point)> edge;  // infinity: no bound
  std::vector<double> region_edge;    // per region of the domain
  std::vector<std::pair<std::int32_t, double>> marker_edge{};  // on lines with a marker
};

struct Simplified {
  Domain domain;
  Simplification changes;
};

// Lines where `finest` is infinite or no number stay as they are. Errors: kEmptyDomain with the
// field "simplify" if nothing is left; kBudgetExceeded, kOutOfMemory, kCancelled and
// kDeadlineExceeded as triangulate. Never throws. Thread-safe.
Result<Simplified> simplify(const Domain& domain, const Finest& finest,
                            const ExecutionContext& context);

}  // namespace weft
