// SPDX-License-Identifier: Apache-2.0
// A size at given places, without a mesh.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/context.h"
#include "engine/domain/domain.h"
#include "engine/size/size_function.h"
#include "weft/error.h"

namespace weft {

// At each point, the least of the size and the bound of its region; on a border of regions, of one
// of them. Infinity for no bound, NaN outside of the domain, 0 where the size is no size. Computes
// in the context's arena. Errors: those of the context.
Result<std::vector<double>> sampled_bounds(const SizeFunction& size, const Domain& domain,
                                           std::span<const Point> points,
                                           const ExecutionContext& context);
// Bytes of memory that this takes at most.
std::uint64_t bytes_to_sample(const Domain& domain, std::size_t points);

}  // namespace weft
