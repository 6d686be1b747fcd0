// SPDX-License-Identifier: Apache-2.0
#include "files/formats/triangle/triangle_segments.h"

#include <optional>
#include <string>

namespace weft::files {

Result<std::optional<Warning>> read_triangle_segments(
    LineScanner& scanner, const NodeNumbers& numbers,
    const std::function<void(const TriangleSegment&)>& take) {
  if (auto line = scanner.next_line("the segment count"); !line)
    return tl::unexpected(line.error());
  const auto count = scanner.count("the segment count");
  if (!count) return tl::unexpected(count.error());
  std::optional<bool> marked;
  if (!scanner.at_line_end()) {
    const auto markers = scanner.integer("the marker count");
    if (!markers) return tl::unexpected(markers.error());
    if (*markers != 0 && *markers != 1)
      return scanner.error("the marker count is " + std::to_string(*markers) +
                           ", it must be 0 or 1");
    marked = *markers == 1;
  }
  std::optional<Warning> warning;
  for (std::uint64_t i = 0; i < *count; ++i) {
    if (auto line = scanner.next_line("a segment"); !line) return tl::unexpected(line.error());
    const auto number = scanner.integer("the segment number");
    if (!number) return tl::unexpected(number.error());
    const auto a = numbers.read(scanner, "the segment's first point");
    if (!a) return tl::unexpected(a.error());
    const auto b = numbers.read(scanner, "the segment's second point");
    if (!b) return tl::unexpected(b.error());
    std::int32_t marker = 0;
    if (marked.value_or(!scanner.at_line_end())) {
      const auto value = scanner.marker("the segment marker");
      if (!value) return tl::unexpected(value.error());
      marker = *value;
    } else if (!scanner.at_line_end() && !warning) {
      warning = {.kind = WarningKind::kColumn,
                 .file = scanner.name(),
                 .line = scanner.line(),
                 .text =
                     "what follows the points of segments is ignored, because their header "
                     "says that they have 0 markers"};
    }
    take({*number, *a, *b, marker});
  }
  return warning;
}

}  // namespace weft::files
