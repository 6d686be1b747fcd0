// SPDX-License-Identifier: Apache-2.0
// Makes the mesh of a domain: coarse phase, quadtree, the leaves' tasks, and the fragments of
// finished leaves, which are sent while others are refined.
#pragma once

#include <optional>

#include "engine/base/context.h"
#include "engine/parallel/mesh_plan.h"
#include "weft/error.h"
#include "weft/mesh.h"

namespace weft {

// Refines and sends the mesh; fills the summary except for earlier stages. The bytes sent depend
// only on the plan and the area bound. Computes in the context's arena, calls the sink on the
// caller's thread. Errors: those of refinement (refine/refiner.h).
template <class AreaBound>
std::optional<Error> run_mesh(const MeshPlan& plan, const AreaBound& area, ChunkSink& sink,
                              ExecutionContext& context, Summary& summary);

}  // namespace weft
