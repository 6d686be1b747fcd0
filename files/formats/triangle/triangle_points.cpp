// SPDX-License-Identifier: Apache-2.0
#include "files/formats/triangle/triangle_points.h"

#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "files/base/words.h"
#include "files/bytes/file_contents.h"
#include "files/bytes/number_text.h"

namespace weft::files {

Result<std::uint32_t> read_index(LineScanner& scanner, std::string_view what, std::int64_t base,
                                 std::size_t count) {
  const auto number = scanner.integer(what);
  if (!number) return tl::unexpected(number.error());
  if (*number < base || *number - base >= static_cast<std::int64_t>(count))
    return scanner.error(std::string(what) + " is " + std::to_string(*number) +
                         ", the numbers run from " + std::to_string(base) + " to " +
                         std::to_string(base + static_cast<std::int64_t>(count) - 1));
  return static_cast<std::uint32_t>(*number - base);
}

namespace {

// What is left of a line if only a marker is: no attribute, which may be any number.
bool is_lone_integer(std::string_view rest) {
  const std::string_view word = trimmed(rest);
  return word.find_first_of(" \t,") == std::string_view::npos && integer_of(word).has_value();
}

// The dimension, and the counts of attributes and markers; nothing for those that are missing.
struct PointHeader {
  std::int64_t attributes = 0;
  std::optional<std::int64_t> markers;
};

Result<PointHeader> read_point_header(LineScanner& scanner) {
  PointHeader header;
  constexpr const char* kNames[] = {"the dimension", "the attribute count", "the marker count"};
  for (int i = 0; i < 3 && !scanner.at_line_end(); ++i) {
    const auto value = scanner.integer(kNames[i]);
    if (!value) return tl::unexpected(value.error());
    const bool wrong = i == 0 ? *value != 2 : *value < 0 || (i == 2 && *value > 1);
    if (wrong)
      return scanner.error(std::string(kNames[i]) + " is " + std::to_string(*value) +
                           (i == 0   ? ", it must be 2"
                            : i == 1 ? ", it must not be negative"
                                     : ", it must be 0 or 1"));
    if (i == 1) header.attributes = *value;
    if (i == 2) header.markers = *value;
  }
  return header;
}

}  // namespace

Result<TrianglePoints> read_triangle_points(LineScanner& scanner) {
  if (auto line = scanner.next_line("the point count"); !line) return tl::unexpected(line.error());
  const auto count = scanner.count("the point count");
  if (!count) return tl::unexpected(count.error());
  if (*count > std::numeric_limits<std::uint32_t>::max())
    return scanner.error("the point count is " + std::to_string(*count) +
                         ", the limit is 4294967295");
  const auto header = read_point_header(scanner);
  if (!header) return tl::unexpected(header.error());

  TrianglePoints section;
  section.points.reserve(*count);
  bool marked = header->markers != 0;
  if (marked) section.markers.reserve(*count);
  for (std::uint64_t i = 0; i < *count; ++i) {
    if (auto line = scanner.next_line("a point"); !line) return tl::unexpected(line.error());
    if (auto number = section.numbers.add(scanner, "the point number"); !number)
      return tl::unexpected(number.error());
    const auto x = scanner.real("the x coordinate");
    if (!x) return tl::unexpected(x.error());
    const auto y = scanner.real("the y coordinate");
    if (!y) return tl::unexpected(y.error());
    section.places.extend(i, scanner.name() + ":", scanner.line());
    section.points.push_back({*x, *y});
    for (std::int64_t k = 0; k < header->attributes; ++k)
      if (auto attribute = scanner.real("an attribute"); !attribute)
        return tl::unexpected(attribute.error());
    if (!header->markers) marked = marked && is_lone_integer(scanner.rest_of_line());
    if (!marked) continue;
    const auto marker = scanner.marker("the point marker");
    if (!marker) return tl::unexpected(marker.error());
    section.markers.push_back(*marker);
  }
  if (!marked) section.markers.clear();
  return section;
}

Result<TrianglePoints> read_node_file(const std::filesystem::path& path) {
  const auto contents = read_text_file(path, kMaxTextBytes);
  if (!contents) return tl::unexpected(contents.error());
  LineScanner scanner(path.string(), contents->text());
  auto section = read_triangle_points(scanner);
  if (section && scanner.try_next_line())
    return scanner.error("the file goes on after its last point");
  return section;
}

}  // namespace weft::files
