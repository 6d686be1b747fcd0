// SPDX-License-Identifier: Apache-2.0
// Points as they come over the wire.
#pragma once

#include <google/protobuf/repeated_field.h>

#include <cstddef>
#include <vector>

#include "weft/geometry.h"

namespace weft::server {

// x0, y0, x1, y1, ...
inline std::vector<Point> to_points(const google::protobuf::RepeatedField<double>& pairs) {
  std::vector<Point> points(static_cast<std::size_t>(pairs.size() / 2));
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = {pairs.data()[2 * i], pairs.data()[2 * i + 1]};
  return points;
}

}  // namespace weft::server
