// SPDX-License-Identifier: Apache-2.0
// Warnings about sizes that are probably not what the client wants.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/geometry.h"
#include "engine/size/size_spec.h"

namespace weft {

struct SizeWarning {
  enum class Kind : std::uint8_t {
    kBoundsNothing,         // larger than the domain everywhere
    kCoarseRaster,          // of sizes: its nodes lie farther apart than the least edge it asks for
    kFieldNotNamed,         // by the expression
    kGradationWithinAlone,  // without a gradation
  };
  Kind kind;
  std::string field;  // its name, if one is meant
  std::string message;
};

// At most one of each kind, but one for each field. `box` is that of the domain, `least_bound` the
// least bound on a triangle's area in the mesh, 0 if there is none.
std::vector<SizeWarning> size_warnings(const SizeSpec& size, const Box& box, double least_bound);

}  // namespace weft
