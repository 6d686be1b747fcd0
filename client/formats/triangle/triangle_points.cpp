// SPDX-License-Identifier: Apache-2.0
#include "client/formats/triangle/triangle_points.h"

#include <limits>
#include <string>

#include "client/formats/files/file_contents.h"

namespace weft::client {

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

Result<void> expect_number(LineScanner& scanner, std::string_view what, std::int64_t number) {
  const auto found = scanner.integer(what);
  if (!found) return tl::unexpected(found.error());
  if (*found != number)
    return scanner.error(std::string(what) + " is " + std::to_string(*found) + ", it should be " +
                         std::to_string(number));
  return {};
}

Result<TrianglePoints> read_triangle_points(LineScanner& scanner) {
  if (auto line = scanner.next_line("the point count"); !line) return tl::unexpected(line.error());
  const auto count = scanner.count("the point count");
  if (!count) return tl::unexpected(count.error());
  if (*count > std::numeric_limits<std::uint32_t>::max())
    return scanner.error("the point count is " + std::to_string(*count) +
                         ", the limit is 4294967295");
  std::int64_t header[] = {2, 0, 0};  // dimension, attributes, markers
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
    header[i] = *value;
  }

  TrianglePoints section;
  section.points.reserve(*count);
  if (header[2] == 1) section.markers.reserve(*count);
  for (std::uint64_t i = 0; i < *count; ++i) {
    if (auto line = scanner.next_line("a point"); !line) return tl::unexpected(line.error());
    if (i == 0) {
      const auto first = scanner.integer("the point number");
      if (!first) return tl::unexpected(first.error());
      if (*first != 0 && *first != 1)
        return scanner.error("the first point number is " + std::to_string(*first) +
                             ", it must be 0 or 1");
      section.base = *first;
    } else if (auto number = expect_number(scanner, "the point number",
                                           section.base + static_cast<std::int64_t>(i));
               !number) {
      return tl::unexpected(number.error());
    }
    const auto x = scanner.real("the x coordinate");
    if (!x) return tl::unexpected(x.error());
    const auto y = scanner.real("the y coordinate");
    if (!y) return tl::unexpected(y.error());
    section.places.extend(i, scanner.name() + ":", scanner.line());
    section.points.push_back({*x, *y});
    for (std::int64_t k = 0; k < header[1]; ++k)
      if (auto attribute = scanner.real("an attribute"); !attribute)
        return tl::unexpected(attribute.error());
    if (header[2] == 1) {
      const auto marker = scanner.marker("the point marker");
      if (!marker) return tl::unexpected(marker.error());
      section.markers.push_back(*marker);
    }
  }
  return section;
}

Result<TrianglePoints> read_node_file(const std::filesystem::path& path) {
  const auto contents = read_file(path, kMaxTextBytes);
  if (!contents) return tl::unexpected(contents.error());
  LineScanner scanner(path.string(), contents->text());
  auto section = read_triangle_points(scanner);
  if (section && scanner.try_next_line())
    return scanner.error("the file goes on after its last point");
  return section;
}

}  // namespace weft::client
