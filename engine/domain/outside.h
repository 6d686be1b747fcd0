// SPDX-License-Identifier: Apache-2.0
// What of a PSLG is no part of the domain.
#pragma once

#include "engine/domain/arrangement/arrangement.h"
#include "engine/domain/carve.h"
#include "engine/domain/stop_poller.h"
#include "weft/mesh.h"
#include "weft/pslg.h"

namespace weft {

// Segments beside the areas of which no part stays. Throws Stopped.
OutsideSegments find_outside(const Arrangement& arrangement, const Carving& carving,
                             const Pslg& pslg, StopPoller& poller);

}  // namespace weft
