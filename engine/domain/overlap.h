// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace weft {

// Where areas of a PSLG cover what others cover, holes not counted.
struct Overlap {
  std::uint64_t areas = 0;  // that share a face with another
  double area = 0;          // of these faces, in squared units
  bool united = false;      // or else, by even-odd filling, not meshed where an even number overlap
};

}  // namespace weft
