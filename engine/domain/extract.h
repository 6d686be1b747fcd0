// SPDX-License-Identifier: Apache-2.0
// The domain that is left of an arrangement once its faces are judged.
#pragma once

#include "engine/domain/arrangement/arrangement.h"
#include "engine/domain/carve.h"
#include "engine/domain/domain.h"
#include "engine/domain/stop_poller.h"

namespace weft {

// Keeps what the carving keeps, numbered without gaps. REQUIRES: it keeps a triangle. Throws
// Stopped.
Domain extract(const Arrangement& arrangement, Carving&& carving, StopPoller& poller);

}  // namespace weft
