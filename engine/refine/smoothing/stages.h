// SPDX-License-Identifier: Apache-2.0
// Refinement in stages, for fewer triangles: where no lattice follows the size, a triangle that is
// a little too large is split in two or more, each about half of what it may be. So first only
// triangles that are much too large are split; then vertices move until the triangles around them
// are equally large for their bounds (equaliser.h); and only what is still too large after that is
// split by the strict bounds.
//
//   stage   splits what is above     and angles below              then
//   1       3 times its bound        the bound
//   2       1.3 times                20 degrees, or a lesser bound   two sweeps
//   3       1.1 times                the same                        two sweeps
//   4       its bound                the bound
//
// The first stage settles the places where the domain, not the size, asks for triangles: its
// triangles are large, so that points for skinny ones repair many. Elsewhere the sweeps widen most
// angles below a bound of more than 20 degrees, and points would be in vain. The lattice
// (lattice.h) has no slack, nor has a place where the size jumps.
//
// The distance from a triangle to the point that splits it is at most its circumradius. Halos are
// laid out for that of the paper's equation 5, where a triangle meets its bounds; before the last
// stage, and after moves, it is that of a larger area and a lesser angle. A cavity that reaches
// beyond the halo for that is deferred like any other (ownership.h): halos decide how much is
// deferred, and never whether the mesh is right.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/refine/refinement_stage.h"
#include "engine/refine/storage/slots.h"
#include "weft/error.h"

namespace weft {

inline constexpr RefinementStage kFirstStage{3, false};
inline constexpr RefinementStage kSweptStages[] = {{1.3, true}, {1.1, true}};
inline constexpr std::uint32_t kSweeps = 2;  // after each of these

// Refines what is queued in stages. REQUIRES: the refiner and the equaliser have begun the same
// task, whose slots these are, and the refiner is in the first stage.
template <class Refiner, class Equaliser>
std::optional<Error> refine_in_stages(Refiner& refiner, Equaliser& equaliser, const Slots& slots) {
  if (auto error = refiner.run()) return error;
  for (const RefinementStage& stage : kSweptStages) {
    refiner.begin_stage(stage, equaliser.touched());
    if (auto error = refiner.run()) return error;
    if (auto error = equaliser.run(slots, stage.slack, kSweeps)) return error;
  }
  refiner.begin_stage({}, equaliser.touched());
  return refiner.run();
}

}  // namespace weft
