// SPDX-License-Identifier: Apache-2.0
// Colours of drawings.
#pragma once

#include <cstddef>
#include <cstdint>

namespace weft::client {

struct Color {
  double red = 0;
  double green = 0;
  double blue = 0;
};

inline constexpr Color kPaper{1, 1, 1};
inline constexpr Color kEdgeInk{0.16, 0.22, 0.34};
inline constexpr Color kBoundaryInk{0.04, 0.07, 0.16};
inline constexpr Color kBoxInk{0.84, 0.15, 0.10};
inline constexpr Color kMarkInk{0.90, 0.05, 0.35};
inline constexpr Color kTriangleLabelInk{0.05, 0.36, 0.62};

// The perceptually uniform map viridis (S. van der Walt and N. Smith, 2015, CC0), t from 0 to 1.
Color viridis(double t);

// The colour of the marks of a kind, one of seven of theirs (see below), which repeat.
Color mark_color(std::size_t kind);

// The colour of a region: grey for 0, otherwise one of eight that the colour-blind can tell apart
// (M. Okabe and K. Ito, 2008), lightened.
Color region_color(std::int32_t id);

}  // namespace weft::client
