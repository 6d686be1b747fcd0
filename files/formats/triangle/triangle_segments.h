// SPDX-License-Identifier: Apache-2.0
// The segment section of Triangle's .poly files:
//   <segments> <markers, 0 or 1>
//   <number> <point> <point> [marker]
// If the count of markers is missing, a segment has the marker that its line ends in, or 0. If it
// is 0, what else a line has is ignored, as Triangle does, with a warning.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "files/base/error.h"
#include "files/bytes/line_scanner.h"
#include "files/bytes/node_numbers.h"
#include "files/formats/warning.h"

namespace weft::files {

struct TriangleSegment {
  std::int64_t number;  // that the file gives it
  std::uint32_t a, b;   // indices of points
  std::int32_t marker;
};

// Reads the section that starts at the scanner's next line, and hands over each segment while the
// scanner is at its line. Returns a warning, if there is one.
Result<std::optional<Warning>> read_triangle_segments(
    LineScanner& scanner, const NodeNumbers& numbers,
    const std::function<void(const TriangleSegment&)>& take);

}  // namespace weft::files
