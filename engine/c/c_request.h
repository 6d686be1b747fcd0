// SPDX-License-Identifier: Apache-2.0
// A request of the C interface (weft/c.h) as the engine's own.
#pragma once

#include "weft/c.h"
#include "weft/weft.h"

namespace weft {

// Copies all that the request points to. Errors: kBadOption with the field's path for a pointer
// that is null although its count is not, an enumerator that is none, and grids without nodes or
// spacings. Throws std::bad_alloc.
Result<MeshRequest> to_engine(const weft_request& request);

}  // namespace weft
