// SPDX-License-Identifier: Apache-2.0
// The gradation within the domain, which is measured on a mesh of its own (mesh_limit.h).
#pragma once

#include "engine/base/context.h"
#include "engine/base/geometry.h"
#include "engine/domain/domain.h"
#include "engine/size/fields/mesh_field.h"
#include "engine/size/size_function.h"
#include "weft/error.h"
#include "weft/weft.h"

namespace weft {

// Makes a mesh of the domain with a share of the sizes in `across`, which are limited across land,
// and on it a length of edges that grows by at most the gradation along any path in the domain, and
// is nowhere above `size`, or what grows from segments with sizes of their own and from regions;
// effectively infinite in parts of the domain without any. `ground` is the domain without arcs,
// `box` around all vertices that a mesh may have. Errors: those of refinement and of the context.
Result<MeshField> limit_within(const MeshRequest& request, const Domain& domain,
                               const Domain& ground, const Box& box, const SizeFunction& across,
                               const SizeFunction& size, const ExecutionContext& context);

}  // namespace weft
