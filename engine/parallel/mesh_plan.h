// SPDX-License-Identifier: Apache-2.0
// What a run knows of its mesh before it begins: the domain, the bounds, how many triangles to
// expect, and how these are cut into leaves of the quadtree. Lengths are in units of the domain.
//
// A plan refers to the domain and what was found of it, which outlive it. Thread-safety: immutable
// while a run uses it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "engine/domain/domain.h"
#include "engine/parallel/narrow_places.h"
#include "engine/refine/acute_corners.h"
#include "engine/refine/edge_limits.h"
#include "engine/refine/periodic_sides.h"
#include "engine/refine/quality_bounds.h"

namespace weft {

// Up to this minimum angle, in degrees, the fragments of a large mesh are sent while others are
// refined. Above it, the clean-up's points make skinny triangles far around, some of them near
// leaves that were sent: in one domain of 270 with small leaves, and in none of 8,000 up to this
// angle. So above it all is cleaned up before anything is sent, and a stream begins when the work
// is nearly done.
inline constexpr double kMaxStreamingAngleDeg = 30;

// The maximum number of triangles in a leaf, for a mesh of about `triangles`. Small leaves keep
// many threads busy, large ones need fewer instructions. A mesh that streams takes the memory of a
// strip a few leaves wide, which is smaller if its leaves are, and about 3 kB per leaf, for its
// tasks and for the triangles of the coarse mesh. The sum is least if leaves grow as the cube root
// of the mesh (bench/README.md).
inline double leaf_triangles_for(double triangles) {
  const double least = std::clamp(0.4 * std::sqrt(triangles), 6'000.0, 16'000.0);
  return std::clamp(3.2e10 / triangles, least, std::max(least, 12'000.0));
}

struct MeshPlan {
  const Domain& domain;
  Box box;  // of the domain
  QualityBounds quality;
  const AcuteCorners& corners;  // of the domain
  const NarrowPlaces& narrow;
  double expected_triangles;
  double expected_by_size;  // of these, what the size alone makes
  bool may_stream;          // the minimum angle is at most kMaxStreamingAngleDeg
  double leaf_triangles;    // maximum triangles of the final mesh in a leaf of the quadtree
  double triangles_lower_bound;
  std::uint32_t sweeps = 0;  // of smoothing
  // Stops at so many triangles: then one task refines in order. If fewer are enough, the mesh is
  // the same as without this bound; nothing is sent before that is known.
  std::optional<std::uint64_t> max_triangles = std::nullopt;
  std::uint64_t other_bytes = 0;  // held by the run besides
  EdgeLimits edge_limits{};       // on segments
  PeriodicSides sides{};          // with any, the mesh does not stream

  // The maximum number of full leaves in a block of the coarse mesh (coarse_blocks.h); 1 for no
  // blocks. Before the first leaf, a coarse mesh for all blocks is made, and then some hundred
  // blocks near the first one. Together these are least if a block grows as the root of the mesh.
  // Smaller blocks leave too many slots unused. A mesh of few leaves has small blocks all the same,
  // so that many threads soon have work.
  double leaves_per_block() const {
    constexpr double kMinLeaves = 32;
    constexpr double kFewLeaves = 256;
    const double leaves = expected_by_size / leaf_triangles;
    if (leaves < kMinLeaves) return 1;
    return std::max<double>(leaves < kFewLeaves ? 6 : 16, std::sqrt(0.025 * leaves));
  }

  // Whether leaves pay. Up to some 60,000 triangles that the bound on angles makes, one task is
  // faster, because the coarse phase costs more than two threads save.
  bool wants_leaves() const {
    constexpr double kByAngles = 4;  // leaves full
    return expected_by_size > leaf_triangles || expected_triangles > kByAngles * leaf_triangles;
  }
};

}  // namespace weft
