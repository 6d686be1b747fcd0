// SPDX-License-Identifier: Apache-2.0
// Which faces of an arrangement belong to the domain, and to which region.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/domain/arrangement/arrangement.h"
#include "engine/domain/domain.h"
#include "engine/domain/stop_poller.h"
#include "weft/error.h"
#include "weft/pslg.h"

namespace weft {

struct Carving {
  // Per triangle of the arrangement: an index into `regions`, or kNone if it is carved away.
  std::vector<std::uint32_t> region;
  std::vector<Region> regions;  // regions[0] is the default
  Overlap overlap;
  OutsideSegments outside{};  // see find_outside
};

// Errors: kSeedOutsideDomain, kSeedOnSegment, kEmptyDomain. Throws Stopped.
Result<Carving> carve(const Arrangement& arrangement, const Pslg& pslg, StopPoller& poller);

}  // namespace weft
