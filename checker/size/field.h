// SPDX-License-Identifier: Apache-2.0
// What a size expression may name: a number at every point, NaN where it is undefined.
#pragma once

#include <functional>
#include <string>

#include "checker/domain.h"

namespace weft::check {

// Not thread-safe: one per thread.
struct Field {
  std::string name;
  std::function<double(Vec2)> value;  // empty: the checker cannot judge it
  std::function<double(Vec2)> slope;  // the length of the gradient
};

}  // namespace weft::check
