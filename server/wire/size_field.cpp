// SPDX-License-Identifier: Apache-2.0
#include "server/wire/size_field.h"
#include "server/wire/points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>

namespace weft::server {
namespace {

Failure bad_array(std::string field, std::string message) {
  return {Reason::kBadArray, std::move(field), std::move(message)};
}

Failure bad_number(std::string field, double value, std::string_view what) {
  std::string message = fmt::format("{} is {}; it must be {}", field, value, what);
  return bad_option(std::move(field), std::move(message));
}

// The shape of a Raster or a FieldRaster, which errors call `path`.
template <class Grid>
std::optional<Failure> check_grid(const Grid& grid, const std::string& path) {
  for (const auto& [name, value] : {std::pair{".x", grid.x()}, std::pair{".y", grid.y()}})
    if (!std::isfinite(value)) return bad_number(path + name, value, "finite");
  for (const auto& [name, value] : {std::pair{".dx", grid.dx()}, std::pair{".dy", grid.dy()}})
    if (!(std::isfinite(value) && value > 0))
      return bad_number(path + name, value, "positive and finite");
  const std::uint64_t nodes = std::uint64_t{grid.columns()} * grid.rows();
  if (nodes == 0 || nodes != static_cast<std::uint64_t>(grid.values_size()))
    return bad_array(path + ".values",
                     fmt::format("{}.values holds {} values for {} columns and {} rows; it takes "
                                 "one per node, and at least one node",
                                 path, grid.values_size(), grid.columns(), grid.rows()));
  return std::nullopt;
}

std::optional<Failure> check_length(const std::string& field, int length, int divisor,
                                    std::string_view what) {
  if (length % divisor == 0) return std::nullopt;
  return bad_array(field, fmt::format("{} holds {} numbers; {} come in {}", field, length, what,
                                      divisor == 2 ? "pairs" : "threes"));
}

std::optional<Failure> check_distance(const v1::Distance& distance, const std::string& path) {
  if (auto f = check_length(path + ".points", distance.points_size(), 2, "coordinates")) return f;
  return check_length(path + ".segments", distance.segments_size(), 2, "point indices");
}

std::optional<Failure> check_mesh(const v1::FieldMesh& mesh, const std::string& path) {
  if (auto f = check_length(path + ".vertices", mesh.vertices_size(), 2, "coordinates")) return f;
  if (auto f = check_length(path + ".triangles", mesh.triangles_size(), 3, "vertex indices"))
    return f;
  if (mesh.triangles_size() == 0)
    return bad_array(path + ".triangles", path + ".triangles is empty; it takes at least one");
  if (mesh.values_size() == mesh.vertices_size() / 2) return std::nullopt;
  return bad_array(path + ".values",
                   fmt::format("{}.values holds {} values for {} vertices; it takes one per vertex",
                               path, mesh.values_size(), mesh.vertices_size() / 2));
}

std::optional<Failure> check_field(const v1::NamedField& field, const std::string& path) {
  switch (field.kind_case()) {
    case v1::NamedField::kDistance:
      return check_distance(field.distance(), path + ".distance");
    case v1::NamedField::kRaster:
      return check_grid(field.raster(), path + ".raster");
    case v1::NamedField::kMesh:
      return check_mesh(field.mesh(), path + ".mesh");
    case v1::NamedField::kWidth:
      return std::nullopt;
    case v1::NamedField::KIND_NOT_SET:
      break;
  }
  return bad_option(path,
                    path + " has no kind; it must be a distance, a raster, a mesh or a width");
}

// Rows of N.
template <std::size_t N>
std::vector<std::array<std::uint32_t, N>> to_rows(
    const google::protobuf::RepeatedField<std::uint32_t>& numbers) {
  std::vector<std::array<std::uint32_t, N>> rows(static_cast<std::size_t>(numbers.size()) / N);
  for (std::size_t i = 0; i < rows.size(); ++i)
    std::copy_n(numbers.data() + N * i, N, rows[i].begin());
  return rows;
}

FieldSpec to_engine(const v1::NamedField& field) {
  FieldSpec spec{field.name(), WidthSpec{}};
  if (field.has_distance()) {
    const v1::Distance& distance = field.distance();
    spec.kind = DistanceSpec{{distance.markers().begin(), distance.markers().end()},
                             to_points(distance.points()),
                             to_rows<2>(distance.segments())};
  } else if (field.has_raster()) {
    const v1::FieldRaster& raster = field.raster();
    spec.kind = FieldRaster{
        {raster.x(), raster.y()}, raster.dx(),   raster.dy(),
        raster.columns(),         raster.rows(), {raster.values().begin(), raster.values().end()}};
  } else if (field.has_mesh()) {
    const v1::FieldMesh& mesh = field.mesh();
    spec.kind = FieldMesh{to_points(mesh.vertices()),
                          to_rows<3>(mesh.triangles()),
                          {mesh.values().begin(), mesh.values().end()}};
  }
  return spec;
}

SizeSpec::Value value_of(const v1::SizeField& size) {
  switch (size.field_case()) {
    case v1::SizeField::kConstant:
      return size.constant();
    case v1::SizeField::kExpression:
      return size.expression();
    case v1::SizeField::kRaster: {
      const v1::Raster& raster = size.raster();
      return Raster{{raster.x(), raster.y()},
                    raster.dx(),
                    raster.dy(),
                    raster.columns(),
                    raster.rows(),
                    {raster.values().begin(), raster.values().end()}};
    }
    case v1::SizeField::FIELD_NOT_SET:
      break;
  }
  return {};
}

// The size without its arrays: of its fields, the names.
SizeSpec without_arrays(const v1::SizeField& size) {
  SizeSpec spec;
  if (!size.has_raster()) spec.value = value_of(size);
  if (size.measure() == v1::MEASURE_EDGE) spec.measure = Measure::kEdge;
  spec.gradation = size.gradation();
  spec.gradation_within = size.gradation_within();
  spec.cells_across = size.cells_across();
  for (const v1::SizeAt& at : size.at()) spec.at.push_back({at.marker(), at.max_edge()});
  for (const v1::NamedField& field : size.fields()) {
    spec.fields.push_back({field.name(), {}});
    if (field.has_width()) spec.fields.back().kind = WidthSpec{};
  }
  return spec;
}

}  // namespace

std::optional<Failure> check_shape(const v1::SizeField& size) {
  if (!v1::Measure_IsValid(size.measure()))
    return bad_option("size.measure", fmt::format("size.measure is {}, which is not a Measure",
                                                  static_cast<int>(size.measure())));
  for (int i = 0; i < size.fields_size(); ++i)
    if (auto f = check_field(size.fields(i), fmt::format("size.fields[{}]", i))) return f;
  return size.has_raster() ? check_grid(size.raster(), "size.raster") : std::nullopt;
}

std::optional<Failure> check_values(const v1::SizeField& size) {
  std::optional<Error> error = check_size(without_arrays(size));
  if (!error && size.has_raster()) {
    const auto& values = size.raster().values();
    error = check_raster_values({values.data(), static_cast<std::size_t>(values.size())},
                                size.raster().columns());
  }
  return error ? std::optional(failure_of(*error)) : std::nullopt;
}

SizeSpec to_engine(const v1::SizeField& size) {
  SizeSpec spec = without_arrays(size);
  if (size.has_raster()) spec.value = value_of(size);
  for (int i = 0; i < size.fields_size(); ++i)
    spec.fields[static_cast<std::size_t>(i)] = to_engine(size.fields(i));
  return spec;
}

}  // namespace weft::server
