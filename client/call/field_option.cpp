// SPDX-License-Identifier: Apache-2.0
#include "client/call/field_option.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "client/base/option_row.h"
#include "client/base/text.h"
#include "client/formats/domain_formats.h"
#include "client/formats/field_raster.h"
#include "client/formats/vertex_values.h"

namespace weft::client {
namespace {

using Warnings = std::vector<std::string>;

void extend(RasterBox& box, Point point, bool is_first) {
  if (is_first) box = {point.x, point.y, point.x, point.y};
  box.min_x = std::min(box.min_x, point.x);
  box.min_y = std::min(box.min_y, point.y);
  box.max_x = std::max(box.max_x, point.x);
  box.max_y = std::max(box.max_y, point.y);
}

RasterBox box_of(const Domain& domain) {
  RasterBox box;
  for (const Point& point : domain.points) extend(box, point, &point == domain.points.data());
  return box;
}

bool meet(const RasterBox& a, const RasterBox& b) {
  return a.min_x <= b.max_x && b.min_x <= a.max_x && a.min_y <= b.max_y && b.min_y <= a.max_y;
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
  Result<Warnings> operator()(const FieldOption::OnMesh& on_mesh) const {
    const auto read = read_vertex_values(on_mesh.file, on_mesh.array);
    if (!read) return tl::unexpected(read.error());
    const std::vector<double>& from = read->mesh.coordinates;
    v1::FieldMesh& to = *out.mutable_mesh();
    RasterBox box;
    to.mutable_vertices()->Reserve(static_cast<int>(from.size()));
    for (std::size_t i = 0; i < from.size(); i += 2) {
      Point at{from[i], from[i + 1]};
      if (projection != nullptr && !projection->to_metres()) at = projection->to_plane(at);
      if (!std::isfinite(at.x) || !std::isfinite(at.y))
        return fail(ExitCode::kUnreadableInput,
                    on_mesh.file.string() + ": vertex " + std::to_string(i / 2) +
                        " cannot be projected from longitude and latitude " +
                        coordinates(from[i], from[i + 1]));
      to.add_vertices(at.x);
      to.add_vertices(at.y);
      extend(box, at, i == 0);
    }
    to.mutable_triangles()->Add(read->mesh.triangles.begin(), read->mesh.triangles.end());
    to.mutable_values()->Add(read->values.begin(), read->values.end());
    if (meet(box, box_of(domain))) return Warnings();
    return Warnings{on_mesh.file.string() + ": this mesh lies apart from the domain, from " +
                    coordinates(box.min_x, box.min_y) + " to " + coordinates(box.max_x, box.max_y) +
                    "; the field " + out.name() + " has the values of its boundary"};
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

// FILE:ARRAY, as a raster's file and band; if there is no such file, as its last colon divides it.
FieldOption::OnMesh mesh_and_array(const std::string& text) {
  auto [file, array] = split_raster_path(text);
  const std::size_t colon = text.rfind(':');
  if (array.empty() && colon != std::string::npos && !std::filesystem::exists(file))
    return {text.substr(0, colon), text.substr(colon + 1)};
  return {std::move(file), std::move(array)};
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
  const std::string mesh = "mesh:";
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
  } else if (kind.starts_with(mesh)) {
    OnMesh on_mesh = mesh_and_array((folder / kind.substr(mesh.size())).string());
    if (auto ok = check_has_vertex_values(on_mesh.file); !ok)
      return tl::unexpected(ok.error().message);
    field.kind = std::move(on_mesh);
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
