// SPDX-License-Identifier: Apache-2.0
// What the tasks of a job share, and what they tell and hand on.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/context.h"
#include "engine/domain/domain.h"
#include "engine/refine/acute_corners.h"
#include "engine/refine/mesh.h"
#include "engine/refine/quality_bounds.h"

namespace weft {

// What all tasks of a job share.
struct Setting {
  Mesh& mesh;
  const AcuteCorners& corners;
  const std::vector<Region>& regions;
  ExecutionContext& context;
  std::uint64_t other_bytes;     // that the job holds besides the mesh
  std::uint64_t triangle_limit;  // an error beyond
};

// What refiners have done.
struct RefinerFigures {
  std::uint64_t insertions = 0;
  std::uint64_t exact_predicates = 0;
  std::uint64_t bytes = 0;  // of one refiner, at the peak

  RefinerFigures& operator+=(const RefinerFigures& other) {
    insertions += other.insertions;
    exact_predicates += other.exact_predicates;
    bytes = std::max(bytes, other.bytes);
    return *this;
  }
};

// A bad triangle as tasks hand it on: gone if the slot has another first vertex.
struct BadTriangle {
  std::uint32_t triangle;
  std::uint32_t first_vertex;
};

}  // namespace weft
