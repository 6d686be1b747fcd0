// SPDX-License-Identifier: GPL-3.0-or-later
// What the benchmarks share: requests, a sink, medians.
#pragma once

#include <algorithm>
#include <charconv>
#include <string>
#include <utility>
#include <vector>

#include "weft/weft.h"

namespace weft::bench {

struct Discard : ChunkSink {
  bool accept(Chunk&&) override { return true; }
};

// REQUIRES: at least one value.
inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

inline std::string shortest_text(double value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

// The grading of a flow around a cylinder, for about so many triangles on cylinder.poly: the
// paper's, with abs(y) < 5 in the wake where the paper prints y < 5.
inline std::string cylinder_size(double triangles) {
  return "(x>=0 && abs(y)<5) || (x<0 && x^2+y^2<25) ? " + shortest_text(1200 / triangles) + " : " +
         shortest_text(1e4 / triangles);
}

}  // namespace weft::bench
