// SPDX-License-Identifier: Apache-2.0
#include "files/message/domain_message.h"

#include <algorithm>
#include <protozero/pbf_writer.hpp>
#include <string_view>
#include <vector>

#include "files/message/field_path.h"

namespace weft::files {
namespace {

using protozero::pbf_writer;

void add_points(pbf_writer& message, std::uint32_t field, const std::vector<Point>& points) {
  if (points.empty()) return;
  protozero::packed_field_double out(message, field);
  for (const Point& point : points) {
    out.add_element(point.x);
    out.add_element(point.y);
  }
}

void add_names(pbf_writer& message, std::uint32_t field, const NameTable& table) {
  for (const auto& [id, text] : table) {
    pbf_writer name(message, field);
    name.add_sint32(1, id);
    name.add_string(2, text);
  }
}

std::int32_t enumerator_of(Domain::Fill fill) {
  switch (fill) {
    case Domain::Fill::kSeeds:
      return 1;
    case Domain::Fill::kEvenOdd:
      return 2;
    case Domain::Fill::kUnion:
      return 3;
  }
  return 0;
}

void add_segments(pbf_writer& message, const std::vector<Domain::Segment>& segments) {
  if (segments.empty()) return;
  {
    protozero::packed_field_uint32 ends(message, 2);
    for (const Domain::Segment& segment : segments) {
      ends.add_element(segment.a);
      ends.add_element(segment.b);
    }
  }
  const auto is_marked = [](const Domain::Segment& segment) { return segment.marker != 0; };
  if (std::ranges::none_of(segments, is_marked)) return;
  protozero::packed_field_sint32 markers(message, 3);
  for (const Domain::Segment& segment : segments) markers.add_element(segment.marker);
}

void add_areas(pbf_writer& message, const Domain& domain) {
  if (domain.areas.empty()) return;
  for (const Domain::Area& given : domain.areas) {
    pbf_writer area(message, 10);
    if (given.region) area.add_sint32(1, *given.region);
    if (given.max_area) area.add_double(2, *given.max_area);
    area.add_bool(5, given.is_hole);  // always: writers leave messages out that stay empty
  }
  protozero::packed_field_uint32 borders(message, 11);
  for (const Domain::Segment& segment : domain.segments) borders.add_element(segment.area);
}

void add_arcs(pbf_writer& message, const std::vector<Domain::Arc>& arcs) {
  if (arcs.empty()) return;
  {
    protozero::packed_field_uint32 segments(message, 12);
    for (const Domain::Arc& arc : arcs) segments.add_element(arc.segment);
  }
  protozero::packed_field_double bulges(message, 13);
  for (const Domain::Arc& arc : arcs) bulges.add_element(arc.bulge);
}

}  // namespace

std::string domain_message(const Domain& domain) {
  std::string bytes;
  pbf_writer message(bytes);
  add_points(message, 1, domain.points);
  add_segments(message, domain.segments);
  add_points(message, 4, domain.holes);
  for (const Domain::Region& region : domain.regions) {
    pbf_writer seed(message, 5);
    seed.add_double(1, region.at.x);
    seed.add_double(2, region.at.y);
    seed.add_sint32(3, region.id);
    if (region.max_area) seed.add_double(4, *region.max_area);
  }
  message.add_enum(6, enumerator_of(domain.fill));
  if (domain.snap > 0) message.add_double(7, domain.snap);
  add_names(message, 8, domain.names.markers);
  add_names(message, 9, domain.names.regions);
  add_areas(message, domain);
  add_arcs(message, domain.arcs);
  return bytes;
}

std::string locate_field(const std::string& field, const Domain& domain) {
  struct List {
    std::string_view name;
    const Provenance& places;
  };
  for (const auto& [list, places] :
       {List{"domain.points", domain.point_places}, List{"domain.segments", domain.segment_places},
        List{"domain.holes", domain.hole_places}, List{"domain.regions", domain.region_places},
        List{"domain.areas", domain.area_places},
        List{"domain.segment_areas", domain.segment_places}})
    if (const auto index = index_in(field, list)) return places.locate(*index);
  return "";
}

}  // namespace weft::files
