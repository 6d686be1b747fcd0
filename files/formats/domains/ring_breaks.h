// SPDX-License-Identifier: Apache-2.0
// Tells the rows that end a ring from corners, in lists of corners that programs such as MATLAB
// write: rows of the same number twice, "-999 -999", as they write where a number is missing.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "files/formats/domain.h"

namespace weft::files {

struct RingCorner {
  Point at;
  bool starts_ring = false;  // for another reason than such a row
};

// Indices of corners, ascending.
struct RingBreaks {
  std::vector<std::size_t> ends;      // rows that end rings
  std::vector<std::size_t> doubtful;  // corners that look like such rows
};

// A row ends a ring if its two numbers are 999, 9999, ... or their negatives, and
//   - the row is outside of the box around the others;
//   - what is left between such rows are rings, of 3 distinct corners or more;
//   - and it is not a corner at the end of a single ring: there are two such rows, or rings on both
//     sides of it, or the ring is closed without it, or it is farther from the ring than the ring
//     is large.
// If only the first is true, it is a doubtful corner.
RingBreaks ring_breaks(std::span<const RingCorner> corners);

}  // namespace weft::files
