// SPDX-License-Identifier: Apache-2.0
// The point section that Triangle's .node and .poly files share:
//   <points> <dimension, 2> <attributes> <markers, 0 or 1>
//   <number> <x> <y> [attributes] [marker]        any numbers, each once
// Attributes are ignored. The header may end after any of its counts. If the count of markers is
// missing, a lone whole number after the attributes of every point is its marker.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "files/base/error.h"
#include "files/bytes/line_scanner.h"
#include "files/bytes/node_numbers.h"
#include "files/formats/domain.h"

namespace weft::files {

// Text files larger than this are refused.
inline constexpr std::uint64_t kMaxTextBytes = std::uint64_t{16} << 30;

struct TrianglePoints {
  std::vector<Point> points;
  std::vector<std::int32_t> markers;  // one per point; empty if the file has none
  NodeNumbers numbers;
  Provenance places;
};

// Reads the section that starts at the scanner's next line.
Result<TrianglePoints> read_triangle_points(LineScanner& scanner);

// Reads a .node file.
Result<TrianglePoints> read_node_file(const std::filesystem::path& path);

// Reads a number of a list whose first is `base`, as an index from 0; returns an error if it is not
// below base + count.
Result<std::uint32_t> read_index(LineScanner& scanner, std::string_view what, std::int64_t base,
                                 std::size_t count);

}  // namespace weft::files
