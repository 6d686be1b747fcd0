// SPDX-License-Identifier: Apache-2.0
// Sizes that fall to 0 on a segment so fast that no triangle on it is ever small enough: those
// where edges may be at most as long as a share of the distance to the segment, such as d/10. A
// triangle of height h on the segment has its centroid at h/3, and at 20 degrees an area of 0.18
// h^2 at least; the bound there is C (h/3)^2, so with C below 1.6 it is too large, whatever h.
#pragma once

#include <optional>

#include "engine/base/context.h"
#include "engine/base/geometry.h"
#include "engine/domain/domain.h"
#include "engine/size/size_function.h"
#include "weft/error.h"

namespace weft {

// The middle of the first piece of a segment on which the size is below `resolved`, the area of the
// least triangle that refinement makes, and beside which it is at most the square of the distance
// and falls as fast; nothing if there is none. Judged at a few places of each piece. Negative sizes
// are not judged. Errors: those of the context.
Result<std::optional<Point>> find_vanishing(const SizeFunction& size, const Domain& domain,
                                            double resolved, const ExecutionContext& context);

}  // namespace weft
