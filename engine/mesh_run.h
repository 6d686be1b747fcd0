// SPDX-License-Identifier: Apache-2.0
// From the domain to the chunks: prelude, quadtree, the leaves' tasks, and the parts of finished
// leaves that leave while others are refined.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/chunk.h"
#include "engine/context.h"
#include "engine/domain/domain.h"
#include "engine/error.h"
#include "engine/refine/quality_bounds.h"
#include "engine/schedule/narrow_places.h"
#include "engine/summary.h"

namespace weft {

struct MeshPlan {
  const Domain& domain;
  Box box;  // of the domain
  QualityBounds quality;
  const NarrowPlaces& narrow;
  double expected_triangles;
  double expected_by_size;   // of these, what the size alone makes
  double leaf_triangles;     // of the final mesh, in a leaf of the quadtree at most
  double least_triangles;    // for certain
  std::uint32_t sweeps = 0;  // of smoothing
  // Stop with what there is at so many: one task refines in order, then. Where fewer are enough,
  // the mesh is the same as without; nothing is sent before that is known.
  std::optional<std::uint64_t> max_triangles = std::nullopt;
  std::uint64_t other_bytes = 0;  // that the job holds besides

  // Whether leaves pay. What the bound on angles makes, one task makes faster up to some 60,000
  // triangles: the coarse phase costs more there than two threads save.
  bool wants_leaves() const {
    constexpr double kByAngles = 4;  // leaves full
    return expected_by_size > leaf_triangles || expected_triangles > kByAngles * leaf_triangles;
  }
};

// Refines and sends the mesh; fills the summary but for the stages before. The bytes sent depend on
// the plan and the area bound alone. Computes in the context's arena, calls the sink on the
// caller's thread. Errors: those of refinement (refine/refiner.h).
template <class AreaBound>
std::optional<Error> run_mesh(const MeshPlan& plan, const AreaBound& area, ChunkSink& sink,
                              ExecutionContext& context, Summary& summary);

}  // namespace weft
