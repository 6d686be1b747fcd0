// SPDX-License-Identifier: Apache-2.0
// A size at given places, without a mesh.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/context.h"
#include "engine/domain/domain.h"
#include "engine/size/size_function.h"
#include "weft/error.h"

namespace weft {

struct SampledSize {
  // At each point, the least of the size and the bound of its region; on a border of regions, of
  // one of them. Infinity for no bound, NaN outside of the domain, 0 where the size is no size.
  std::vector<double> bounds;
  // The integral of 1 / bound over the domain, about: the sum over the cells of a grid.
  double per_bound = 0;
  // In a part of the domain where the size is no size, so that there is no mesh. A place where it
  // alone is none, such as one from which it grows, is no such part.
  std::optional<Point> bad;
};

// Computes in the context's arena. Errors: those of the context.
Result<SampledSize> sample_size(const SizeFunction& size, const Domain& domain,
                                std::span<const Point> points, const ExecutionContext& context);
// Bytes of memory that this takes at most.
std::uint64_t bytes_to_sample(const Domain& domain, std::size_t points);

}  // namespace weft
