// SPDX-License-Identifier: Apache-2.0
#include "files/formats/triangle/triangle_poly.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "files/base/data_path.h"
#include "files/base/text.h"
#include "files/bytes/file_contents.h"
#include "files/bytes/line_scanner.h"
#include "files/bytes/text_writer.h"
#include "files/formats/triangle/triangle_arcs.h"
#include "files/formats/triangle/triangle_names.h"
#include "files/formats/triangle/triangle_points.h"
#include "files/formats/triangle/triangle_segments.h"

namespace weft::files {
namespace {

Result<Point> read_seed(LineScanner& scanner) {
  if (auto number = scanner.integer("the seed number"); !number)
    return tl::unexpected(number.error());
  const auto x = scanner.real("the x coordinate");
  if (!x) return tl::unexpected(x.error());
  const auto y = scanner.real("the y coordinate");
  if (!y) return tl::unexpected(y.error());
  return Point{*x, *y};
}

Result<void> read_holes(LineScanner& scanner, Domain& domain) {
  if (auto line = scanner.next_line("the hole count"); !line) return line;
  const auto count = scanner.count("the hole count");
  if (!count) return tl::unexpected(count.error());
  for (std::uint64_t i = 0; i < *count; ++i) {
    if (auto line = scanner.next_line("a hole"); !line) return line;
    const auto seed = read_seed(scanner);
    if (!seed) return tl::unexpected(seed.error());
    domain.hole_places.extend(i, scanner.name() + ":", scanner.line());
    domain.holes.push_back(*seed);
  }
  return {};
}

// The optional last section.
Result<void> read_regions(LineScanner& scanner, Domain& domain) {
  if (!scanner.try_next_line()) return {};
  const auto count = scanner.count("the region count");
  if (!count) return tl::unexpected(count.error());
  std::vector<double> attributes;
  for (std::uint64_t i = 0; i < *count; ++i) {
    if (auto line = scanner.next_line("a region"); !line) return line;
    const auto seed = read_seed(scanner);
    if (!seed) return tl::unexpected(seed.error());
    const auto attribute = scanner.real("the region's attribute");
    if (!attribute) return tl::unexpected(attribute.error());
    attributes.push_back(*attribute);
    double max_area = *attribute;  // a single value is both
    if (!scanner.at_line_end()) {
      const auto area = scanner.real("the region's maximum area");
      if (!area) return tl::unexpected(area.error());
      max_area = *area;
    }
    Domain::Region region{*seed, 0, std::nullopt};
    if (max_area > 0) region.max_area = max_area;
    domain.region_places.extend(i, scanner.name() + ":", scanner.line());
    domain.regions.push_back(region);
  }
  const RegionIds ids(attributes);
  for (std::size_t i = 0; i < attributes.size(); ++i) domain.regions[i].id = ids.of(attributes[i]);
  domain.region_values = ids.assigned();
  if (scanner.try_next_line()) return scanner.error("the file goes on after its last region");
  return {};
}

// The number that the domain's file has in the place of a region's id, if it is not the id.
std::optional<double> value_of(const Domain& domain, std::int32_t id) {
  const auto found = std::find_if(domain.region_values.begin(), domain.region_values.end(),
                                  [id](const RegionValue& known) { return known.id == id; });
  if (found == domain.region_values.end()) return std::nullopt;
  return found->value;
}

}  // namespace

Result<Domain> read_triangle_poly(const std::filesystem::path& path) {
  const auto contents = read_text_file(path, kMaxTextBytes);
  if (!contents) return tl::unexpected(contents.error());
  LineScanner scanner(path.string(), contents->text());

  auto points = read_triangle_points(scanner);
  if (!points) return tl::unexpected(points.error());
  if (points->points.empty()) {
    if (path == kStandardInput)
      return scanner.error(
          "the points are in a .node file, which has no place beside standard input");
    points = read_node_file(std::filesystem::path(path).replace_extension(".node"));
    if (!points) return tl::unexpected(points.error());
  }
  Domain domain;
  domain.points = std::move(points->points);
  domain.point_markers = std::move(points->markers);
  domain.point_places = std::move(points->places);

  std::vector<std::int64_t> segment_numbers;
  const auto segments =
      read_triangle_segments(scanner, points->numbers, [&](const TriangleSegment& segment) {
        domain.segment_places.extend(domain.segments.size(), scanner.name() + ":", scanner.line());
        domain.segments.push_back({segment.a, segment.b, segment.marker});
        segment_numbers.push_back(segment.number);
      });
  if (!segments) return tl::unexpected(segments.error());
  auto arcs = read_arcs(scanner.name(), contents->text(), segment_numbers);
  if (!arcs) return tl::unexpected(arcs.error());
  domain.arcs = std::move(*arcs);
  if (auto read = read_holes(scanner, domain); !read) return tl::unexpected(read.error());
  if (auto read = read_regions(scanner, domain); !read) return tl::unexpected(read.error());

  NameReader names(path.string());
  for (const auto& [id, value] : domain.region_values)
    names.add(NameKind::kRegion, id, shortest(value));
  read_names(contents->text(), names);
  domain.warnings = names.warnings();
  if (*segments) domain.warnings.push_back(**segments);
  domain.names = names.take();
  return domain;
}

void write_triangle_poly(const Domain& domain, OutputFile& file) {
  const bool marked = !domain.point_markers.empty();
  put_line(file, domain.points.size(), 2, 0, marked ? 1 : 0);
  for (std::size_t i = 0; i < domain.points.size(); ++i) {
    const Point& at = domain.points[i];
    marked ? put_line(file, i + 1, at.x, at.y, domain.point_markers[i])
           : put_line(file, i + 1, at.x, at.y);
  }
  put_line(file, domain.segments.size(), 1);
  for (std::size_t i = 0; i < domain.segments.size(); ++i) {
    const Domain::Segment& segment = domain.segments[i];
    put_line(file, i + 1, segment.a + std::int64_t{1}, segment.b + std::int64_t{1}, segment.marker);
  }
  put_line(file, domain.holes.size());
  for (std::size_t i = 0; i < domain.holes.size(); ++i)
    put_line(file, i + 1, domain.holes[i].x, domain.holes[i].y);
  put_line(file, domain.regions.size());
  for (std::size_t i = 0; i < domain.regions.size(); ++i) {
    const Domain::Region& region = domain.regions[i];
    const double max_area = region.max_area.value_or(-1);
    const auto value = value_of(domain, region.id);
    value ? put_line(file, i + 1, region.at.x, region.at.y, *value, max_area)
          : put_line(file, i + 1, region.at.x, region.at.y, region.id, max_area);
  }
  Names names = domain.names;
  for (const RegionValue& value : domain.region_values) names.regions.erase(value.id);
  put_names(names, file);
  put_arcs(domain.arcs, file);
}

}  // namespace weft::files
