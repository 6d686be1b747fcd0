// SPDX-License-Identifier: Apache-2.0
// A grading function: the upper bound on a triangle's area, in squared units, as a function of its
// centroid. Its bounds over boxes guide the refinement (size_map.h).
#pragma once

#include <optional>

#include "engine/size/field.h"

namespace weft {

class SizeFunction : public Field {
 public:
  // The value, if it is known to be the same everywhere; infinity for no bound.
  virtual std::optional<double> constant() const noexcept { return std::nullopt; }
};

}  // namespace weft
