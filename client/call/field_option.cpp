// SPDX-License-Identifier: Apache-2.0
#include "client/call/field_option.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "client/base/option_row.h"
#include "files/base/did_you_mean.h"
#include "files/base/text.h"
#include "files/formats/derived/vertex_values.h"
#include "files/formats/domain_formats.h"
#include "files/formats/domains/ogr.h"
#include "files/formats/field_raster.h"

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
  std::uint64_t most_raster_values;
  v1::NamedField& out;

  Result<Warnings> operator()(const wire::DomainField& field) const {
    if (const auto ok = wire::fill(field, domain.names.markers, out); !ok)
      return tl::unexpected(ok.error());
    return Warnings();
  }
  Result<Warnings> operator()(const FieldOption::DistanceToFile& distance) const {
    const auto read = read_domain(distance.file);
    if (!read) return tl::unexpected(read.error());
    if (auto same = check_system(distance.file, *read); !same) return tl::unexpected(same.error());
    v1::Distance& to = *out.mutable_distance();
    for (std::size_t i = 0; i < read->points.size(); ++i) {
      const Point point = read->points[i];
      const Point at = projection != nullptr ? projection->to_plane(point) : point;
      if (!std::isfinite(at.x) || !std::isfinite(at.y))
        return unprojected(distance.file, read->point_places.locate(i), "point", i, point);
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
    const auto& [file, band] = raster;
    auto read =
        projection != nullptr
            ? read_field_raster_projected(file, band, box, projection->name(), most_raster_values)
        : domain.system ? read_field_raster_in(file, band, box, *domain.system, most_raster_values)
                        : read_field_raster(file, band, box, most_raster_values);
    if (!read) return tl::unexpected(read.error());
    wire::fill(*read, out);
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
        return unprojected(on_mesh.file, "", "vertex", i / 2, {from[i], from[i + 1]});
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
  // `place` is the point's in the file, if it is known.
  tl::unexpected<Error> unprojected(const std::filesystem::path& file, const std::string& place,
                                    const std::string& what, std::size_t i, Point at) const {
    const bool on_globe = std::abs(at.x) <= 360 && std::abs(at.y) <= 90;
    return fail(
        ExitCode::kUnreadableInput,
        (place.empty() ? file.string() : place) + ": " + what + " " + std::to_string(i) + ", " +
            coordinates(at.x, at.y) + ", " +
            (on_globe ? "is too far from the domain to be projected by " + projection->name()
                      : "is not a longitude and a latitude; are its coordinates metres?"));
  }
  // With a projection, the file's coordinates are longitudes and latitudes. Otherwise it must be in
  // the domain's system, if both name one.
  Result<void> check_system(const std::filesystem::path& file, const Domain& read) const {
    if (!read.system) return {};
    const auto refuse = [&](const std::string& wanted) {
      return fail(ExitCode::kUnreadableInput, file.string() + ": its coordinate system is " +
                                                  in_quotes(read.system->name) + ", " + wanted +
                                                  "; ogr2ogr -t_srs brings it there");
    };
    if (projection != nullptr && !read.system->geographic)
      return refuse("with a projection it must be longitude and latitude");
    if (projection == nullptr && domain.system && !are_same(*read.system, *domain.system))
      return refuse("that of the domain is " + in_quotes(domain.system->name));
    return {};
  }
};

// Whether the text could be a path only if there were such a file.
bool is_mere_word(const std::string& text, const std::filesystem::path& folder) {
  std::error_code ignored;
  return text.find_first_of("./") == std::string::npos &&
         !std::filesystem::exists(folder / text, ignored);
}

// What `kind`, which is none, probably was meant to be.
std::string kind_hint(const std::string& kind) {
  const std::string word = kind.substr(0, kind.find(':'));
  if (word == "width") return "width takes nothing after it";
  if (word == "mesh") return "mesh takes a file, as in mesh:FILE or mesh:FILE:ARRAY";
  const std::string meant = did_you_mean(word, {"distance", "width", "mesh"});
  return meant.empty() ? "the kinds are distance, width and mesh" : meant;
}

// Splits FILE:ARRAY as a raster's file and band are split; if there is no such file, at its last
// colon.
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
  FieldOption field{text.substr(0, equals), wire::DomainField()};
  const std::string kind = text.substr(equals + 1);
  const std::string distance = "distance:";
  const std::string mesh = "mesh:";
  if (auto own = wire::DomainField::parse(kind)) {
    if (!*own) return tl::unexpected(own->error());
    field.kind = std::move(**own);
  } else if (kind.starts_with(distance)) {
    const std::string to = kind.substr(distance.size());
    if (is_mere_word(to, folder)) {
      const std::string meant = did_you_mean(to.substr(0, to.find('=')), {"marker"});
      return tl::unexpected(in_quotes(kind) +
                            " names neither markers, such as distance:marker=2,3, nor a file" +
                            (meant.empty() ? "" : "; " + meant));
    }
    const std::filesystem::path file = folder / to;
    if (!is_domain_path(file)) return tl::unexpected(unknown_domain_format(file).value().message);
    field.kind = DistanceToFile{file};
  } else if (kind.starts_with(mesh) && kind.size() > mesh.size()) {
    OnMesh on_mesh = mesh_and_array((folder / kind.substr(mesh.size())).string());
    if (auto ok = check_has_vertex_values(on_mesh.file); !ok)
      return tl::unexpected(ok.error().message);
    field.kind = std::move(on_mesh);
  } else {
    auto [file, band] = split_raster_path((folder / kind).string());
    if (band.empty() && is_mere_word(kind, folder))
      return tl::unexpected(in_quotes(kind) + " is neither a kind of field nor a file; " +
                            kind_hint(kind));
    field.kind = Raster{std::move(file), std::move(band)};
  }
  return field;
}

Result<std::vector<std::string>> fill(const FieldOption& field, const Domain& domain,
                                      const DomainProjection* projection,
                                      std::uint64_t most_raster_values, v1::NamedField& out) {
  out.set_name(field.name);
  return std::visit(Filler{domain, projection, most_raster_values, out}, field.kind);
}

}  // namespace weft::client
