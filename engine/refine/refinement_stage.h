// SPDX-License-Identifier: Apache-2.0
// The bounds of a stage of refinement (smoothing/stages.h). A value.
#pragma once

namespace weft {

struct RefinementStage {
  double slack = 1;    // a factor of bounds on areas, where no lattice follows the size
  bool eased = false;  // angles of 20 degrees are enough
};

}  // namespace weft
