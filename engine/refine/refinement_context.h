// SPDX-License-Identifier: Apache-2.0
// What the tasks of a run share: the mesh, the domain's corners and limits, the budget. And what
// passes between them: bad triangles that migrate, and statistics.
//
// Errors: those of `check_budget`. Thread-safety: all tasks use one context; who may touch what of
// the mesh is in ownership.h.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/context.h"
#include "engine/domain/domain.h"
#include "engine/refine/acute_corners.h"
#include "engine/refine/edge_limits.h"
#include "engine/refine/quality_bounds.h"
#include "engine/refine/storage/mesh_store.h"

namespace weft {

// Shared by all tasks of a run.
struct RefinementContext {
  MeshStore& mesh;
  const AcuteCorners& corners;
  const std::vector<Region>& regions;
  const EdgeLimits& edge_limits;
  ExecutionContext& context;
  std::uint64_t other_bytes;     // that the run holds all the time, besides the mesh
  std::uint64_t triangle_limit;  // an error beyond
};

// Returns nullopt if the run may hold so many bytes and make so many triangles; it may wait for the
// bytes.
inline std::optional<Error> check_budget(const ExecutionContext& context, std::uint64_t triangles,
                                         std::uint64_t triangle_limit, std::uint64_t bytes) {
  if (triangles > triangle_limit) {
    return Error{
        ErrorCode::kLimitExceeded, "size",
        "the mesh needs more than the limit of " + std::to_string(triangle_limit) + " triangles"};
  }
  return context.need_bytes(bytes, "the mesh");
}

// What refiners have done.
struct RefinerStats {
  std::uint64_t insertions = 0;
  std::uint64_t exact_predicates = 0;
  std::uint64_t bytes = 0;  // of one refiner, at the peak

  RefinerStats& operator+=(const RefinerStats& other) {
    insertions += other.insertions;
    exact_predicates += other.exact_predicates;
    bytes = std::max(bytes, other.bytes);
    return *this;
  }
};

// A bad triangle that migrates to another task. It is gone if the slot has another first vertex.
struct BadTriangle {
  std::uint32_t triangle;
  std::uint32_t first_vertex;
};

}  // namespace weft
