// SPDX-License-Identifier: Apache-2.0
// Refinement in stages, for fewer triangles: where no lattice follows the size, a triangle that is
// a little too large is split in two or more, each about half of what it may be. So first only
// triangles that are much too large are split; then vertices move until the triangles around them
// are equally large for their bounds (equaliser.h); and only what is still too large after that is
// split by the strict bounds.
//
//   stage 1   splits what is above 1.3 times its bound, then two sweeps
//   stage 2   splits what is above 1.1 times its bound, then two sweeps
//   stage 3   splits what is above its bound
//
// Before stage 3, angles of 20 degrees are enough, because the sweeps widen most of those that are
// smaller than a larger bound. The lattice (lattice.h) has no slack, nor has a place where the size
// jumps.
//
// The distance from a triangle to the point that splits it is at most its circumradius. Halos are
// laid out for that of the paper's equation 5, where a triangle meets its bounds; in the first two
// stages, and after moves, it is that of 1.3 times the area at 20 degrees. A cavity that reaches
// beyond the halo for that is deferred like any other (ownership.h): halos decide how much is
// deferred, and never whether the mesh is right.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/refine/storage/slots.h"
#include "weft/error.h"

namespace weft {

struct RefinementStage {
  double slack;          // of bounds on areas: a factor
  std::uint32_t sweeps;  // after the refinement
};
// The strict one follows.
inline constexpr RefinementStage kStages[] = {{1.3, 2}, {1.1, 2}};

// Refines what is queued in stages. REQUIRES: the refiner and the equaliser have begun the same
// task, whose slots these are, and the refiner has judged with the slack of the first stage.
template <class Refiner, class Equaliser>
std::optional<Error> refine_in_stages(Refiner& refiner, Equaliser& equaliser, const Slots& slots) {
  for (const RefinementStage& stage : kStages) {
    if (&stage != kStages) refiner.begin_stage(stage.slack, equaliser.touched());
    if (auto error = refiner.run()) return error;
    if (auto error = equaliser.run(slots, stage.slack, stage.sweeps)) return error;
  }
  refiner.begin_stage(1, equaliser.touched());
  return refiner.run();
}

}  // namespace weft
