// SPDX-License-Identifier: Apache-2.0
// A grading function: the upper bound on a triangle's area, in squared units, as a function of its
// centroid. Its bounds over boxes guide the refinement (size_map.h).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/size/field.h"

namespace weft {

class SizeFunction : public Field {
 public:
  // The value, if it is known to be the same everywhere; infinity for no bound.
  virtual std::optional<double> constant() const noexcept { return std::nullopt; }

  // The fields that it names and that are undefined at p, such as "depth": for errors.
  virtual std::vector<std::string> undefined_at(Point p) const {
    static_cast<void>(p);
    return {};
  }
};

}  // namespace weft
