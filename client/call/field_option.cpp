// SPDX-License-Identifier: Apache-2.0
#include "client/call/field_option.h"

#include <algorithm>
#include <utility>

#include "client/base/option_row.h"
#include "client/base/text.h"
#include "client/formats/domain_formats.h"
#include "client/formats/field_raster.h"

namespace weft::client {
namespace {

using Warnings = std::vector<std::string>;

RasterBox box_of(const Domain& domain) {
  if (domain.points.empty()) return {};
  const Point first = domain.points.front();
  RasterBox box{first.x, first.y, first.x, first.y};
  for (const Point& point : domain.points) {
    box.min_x = std::min(box.min_x, point.x);
    box.min_y = std::min(box.min_y, point.y);
    box.max_x = std::max(box.max_x, point.x);
    box.max_y = std::max(box.max_y, point.y);
  }
  return box;
}

// Fills in the field of a kind.
struct Filler {
  const Domain& domain;
  const DomainProjection* projection;
  v1::NamedField& out;

  Result<Warnings> operator()(const FieldOption::Distance& distance) const {
    out.mutable_distance()->mutable_markers()->Add(distance.markers.begin(),
                                                   distance.markers.end());
    return Warnings();
  }
  Result<Warnings> operator()(const FieldOption::DistanceToFile& distance) const {
    const auto read = read_domain(distance.file);
    if (!read) return tl::unexpected(read.error());
    v1::Distance& to = *out.mutable_distance();
    for (const Point& point : read->points) {
      const Point at = projection != nullptr ? projection->to_plane(point) : point;
      to.add_points(at.x);
      to.add_points(at.y);
    }
    for (const Domain::Segment& segment : read->segments) {
      to.add_segments(segment.a);
      to.add_segments(segment.b);
    }
    return Warnings();
  }
  Result<Warnings> operator()(const FieldOption::Raster& raster) const {
    const RasterBox box = box_of(domain);
    auto read = projection != nullptr
                    ? read_field_raster_projected(raster.file, raster.band, box, projection->name())
                    : read_field_raster(raster.file, raster.band, box);
    if (!read) return tl::unexpected(read.error());
    v1::FieldRaster& to = *out.mutable_raster();
    to.set_x(read->x);
    to.set_y(read->y);
    to.set_dx(read->dx);
    to.set_dy(read->dy);
    to.set_columns(read->columns);
    to.set_rows(read->rows);
    to.mutable_values()->Add(read->values.begin(), read->values.end());
    return std::move(read->warnings);
  }
  Result<Warnings> operator()(const FieldOption::Width&) const {
    out.mutable_width();
    return Warnings();
  }
};

// "2,3" as numbers.
std::optional<std::vector<std::int32_t>> markers_of(const std::string& text) {
  std::vector<std::int32_t> markers;
  std::size_t at = 0;
  while (true) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    const auto marker = value_of<std::int32_t>(text.substr(at, comma - at));
    if (!marker) return std::nullopt;
    markers.push_back(*marker);
    if (comma == text.size()) return markers;
    at = comma + 1;
  }
}

}  // namespace

tl::expected<FieldOption, std::string> FieldOption::parse(const std::string& text,
                                                          const std::filesystem::path& folder) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    return tl::unexpected(in_quotes(text) +
                          " is not NAME=KIND, such as coast=distance or depth=FILE.tif");
  FieldOption field{text.substr(0, equals), Width{}};
  const std::string kind = text.substr(equals + 1);
  const std::string distance = "distance:";
  const std::string marker = "distance:marker=";
  if (kind == "width") return field;
  if (kind == "distance") {
    field.kind = Distance{};
  } else if (kind.starts_with(marker)) {
    auto markers = markers_of(kind.substr(marker.size()));
    if (!markers)
      return tl::unexpected(in_quotes(kind) + " does not list markers, such as marker=2,3");
    field.kind = Distance{std::move(*markers)};
  } else if (kind.starts_with(distance)) {
    const std::filesystem::path file = folder / kind.substr(distance.size());
    if (!is_domain_path(file)) return tl::unexpected(unknown_domain_format(file).value().message);
    field.kind = DistanceToFile{file};
  } else {
    auto [file, band] = split_raster_path((folder / kind).string());
    field.kind = Raster{std::move(file), std::move(band)};
  }
  return field;
}

Result<std::vector<std::string>> fill(const FieldOption& field, const Domain& domain,
                                      const DomainProjection* projection, v1::NamedField& out) {
  out.set_name(field.name);
  return std::visit(Filler{domain, projection, out}, field.kind);
}

}  // namespace weft::client
