// SPDX-License-Identifier: Apache-2.0
// From a domain and its size to the mesh: whether it is admitted, the lattices, the refinement.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>

#include "engine/base/context.h"
#include "engine/base/geometry.h"
#include "engine/domain/domain.h"
#include "engine/layers/layer_filler.h"
#include "engine/layers/layer_plan.h"
#include "engine/refine/periodic_sides.h"
#include "engine/size/size_function.h"
#include "engine/size/size_map.h"
#include "weft/error.h"
#include "weft/mesh.h"
#include "weft/weft.h"

namespace weft {

// Wall time since the last call.
class StageClock {
 public:
  double lap() {
    const auto now = ExecutionContext::Clock::now();
    return std::chrono::duration<double>(now - std::exchange(start_, now)).count();
  }

 private:
  ExecutionContext::Clock::time_point start_ = ExecutionContext::Clock::now();
};

// Layers, and the domain as it was before they made holes in it.
struct LaidOut {
  LaidOut(Domain&& before, LayerPlan&& made, const MeshRequest& request, ChunkSink& sink)
      : domain(std::move(before)),
        plan(std::move(made)),
        filler(request.layers, request.pslg, domain, plan, sink) {}

  Domain domain;
  LayerPlan plan;
  LayerFiller filler;
};

// What is refined. Of the request, only errors and warnings name the `pslg` and the size's value.
struct Refinable {
  const MeshRequest& request;
  const Domain& domain;
  const Domain& ground;  // what the size sees of it: without arcs
  Box box;               // of all vertices that the mesh may have
  const SizeFunction& size;
  const SizeMap* map;        // of a size that varies
  std::uint64_t size_bytes;  // of all that the size is made of
  const PeriodicSides& sides;
  LaidOut* layers;  // null: none
};

// Whether the client set a limit of its own: reaching that is no error.
inline bool has_triangle_cap(const Budget& budget) {
  return budget.max_triangles <= budget.triangle_limit &&
         budget.max_triangles != Budget{}.max_triangles;
}

// Refines, sends the mesh and completes the summary, which has the figures of earlier stages.
// Errors: those of weft::stream that are not of the domain or of what makes the size.
std::optional<Error> refine(const Refinable& ready, ChunkSink& sink, ExecutionContext& context,
                            StageClock& clock, Summary& summary);

}  // namespace weft
