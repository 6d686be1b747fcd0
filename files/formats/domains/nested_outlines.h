// SPDX-License-Identifier: Apache-2.0
// Outlines in outlines, of drawings that have lines alone: a circle in a plate may be a hole, or a
// part of another material. What is bounded is meshed, so a reader tells of them.
#pragma once

#include <cstdint>
#include <vector>

#include "files/formats/domain.h"

namespace weft::files {

// The first segments of the closed chains of segments that lie inside of what other segments
// bound. Consecutive segments that share points by their numbers are a chain. O(n log n + k) for n
// segments and k of them beside closed chains.
std::vector<std::size_t> nested_outlines(const Domain& domain);

}  // namespace weft::files
