// SPDX-License-Identifier: Apache-2.0
#include "engine/c/c_request.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/failure.h"
#include "engine/base/text.h"

namespace weft {
namespace {

[[noreturn]] void refuse(std::string field, std::string message) {
  throw Failure({ErrorCode::kBadOption, std::move(field), std::move(message)});
}

// The first `count` of `numbers`, for an error's `field`.
template <class T>
std::span<const T> array(const T* numbers, std::size_t count, const std::string& field) {
  if (numbers == nullptr && count > 0)
    refuse(field, field + " is NULL, but its count is " + std::to_string(count));
  return {numbers, count};
}

// As `array`, of what may be left out.
template <class T>
std::span<const T> optional_array(const T* numbers, std::size_t count) {
  return numbers == nullptr ? std::span<const T>() : std::span(numbers, count);
}

template <class T>
T enumerator(std::int32_t number, T last, const char* field) {
  if (number < 0 || number > static_cast<std::int32_t>(last))
    refuse(field, std::string(field) + " is " + std::to_string(number) + "; it must be from 0 to " +
                      std::to_string(static_cast<std::int32_t>(last)));
  return static_cast<T>(number);
}

std::vector<Point> points(const double* numbers, std::size_t count, const std::string& field) {
  const auto pairs = array(numbers, 2 * count, field);
  std::vector<Point> points(count);
  for (std::size_t i = 0; i < count; ++i) points[i] = {pairs[2 * i], pairs[2 * i + 1]};
  return points;
}

template <std::size_t N>
std::vector<std::array<std::uint32_t, N>> rows(const std::uint32_t* numbers, std::size_t count,
                                               const std::string& field) {
  const auto all = array(numbers, N * count, field);
  std::vector<std::array<std::uint32_t, N>> rows(count);
  for (std::size_t i = 0; i < count; ++i) std::copy_n(all.data() + N * i, N, rows[i].begin());
  return rows;
}

// On areas, of what errors call `path`.
std::optional<double> bound(const weft_bound& given, const std::string& path) {
  const auto check = [&](const char* name, double value, double area, const char* rule) {
    if (!(std::isfinite(area) && area > 0))
      refuse(path + name,
             path + name + " is " + text(value) + "; it must be positive and finite" + rule);
  };
  std::optional<double> area;
  if (given.has_max_area != 0) {
    area = given.max_area;
    check(".max_area", given.max_area, given.max_area, "");
  }
  if (given.has_max_edge == 0) return area;
  const double by_edge = area_of_edge(given.max_edge);
  check(".max_edge", given.max_edge, by_edge, ", and so must its square");
  return area ? std::min(*area, by_edge) : by_edge;
}

template <class T>
GridOf<T> grid(const weft_grid& given, const T* values, const std::string& path) {
  for (const auto& [name, value] : {std::pair{".x", given.x}, std::pair{".y", given.y}})
    if (!std::isfinite(value))
      refuse(path + name, path + name + " is " + text(value) + "; it must be finite");
  for (const auto& [name, value] : {std::pair{".dx", given.dx}, std::pair{".dy", given.dy}})
    if (!(std::isfinite(value) && value > 0))
      refuse(path + name, path + name + " is " + text(value) + "; it must be positive and finite");
  const std::size_t nodes = std::size_t{given.columns} * given.rows;
  if (nodes == 0) refuse(path + ".values", path + " has no nodes; it takes at least one");
  const auto all = array(values, nodes, path + ".values");
  return {{given.x, given.y}, given.dx,   given.dy,
          given.columns,      given.rows, {all.begin(), all.end()}};
}

FieldSpec field(const weft_field& given, const std::string& path) {
  FieldSpec spec{given.name == nullptr ? "" : given.name, WidthSpec{}};
  switch (given.kind) {
    case WEFT_FIELD_DISTANCE: {
      const std::string at = path + ".distance";
      const auto markers = array(given.markers, given.marker_count, at + ".markers");
      spec.kind = DistanceSpec{{markers.begin(), markers.end()},
                               points(given.points, given.point_count, at + ".points"),
                               rows<2>(given.segments, given.segment_count, at + ".segments")};
      return spec;
    }
    case WEFT_FIELD_RASTER:
      spec.kind = grid(given.grid, given.grid_values, path + ".raster");
      return spec;
    case WEFT_FIELD_MESH: {
      const std::string at = path + ".mesh";
      const auto values = array(given.point_values, given.point_count, at + ".values");
      spec.kind = FieldMesh{points(given.points, given.point_count, at + ".vertices"),
                            rows<3>(given.triangles, given.triangle_count, at + ".triangles"),
                            {values.begin(), values.end()}};
      return spec;
    }
    case WEFT_FIELD_WIDTH:
      return spec;
    default:
      refuse(path, path + " has no kind; it must be a distance, a raster, a mesh or a width");
  }
}

// The path of the next element.
template <class T>
std::string at(const char* field, const std::vector<T>& elements) {
  return std::string(field) + '[' + std::to_string(elements.size()) + ']';
}

Pslg pslg(const weft_request& request) {
  Pslg pslg;
  pslg.points = points(request.points, request.point_count, "domain.points");
  pslg.holes = points(request.holes, request.hole_count, "domain.holes");
  const auto ends = rows<2>(request.segments, request.segment_count, "domain.segments");
  const auto markers = optional_array(request.segment_markers, ends.size());
  const auto areas = optional_array(request.segment_areas, ends.size());
  pslg.segments.reserve(ends.size());
  for (std::size_t i = 0; i < ends.size(); ++i)
    pslg.segments.push_back({ends[i][0], ends[i][1], markers.empty() ? 0 : markers[i],
                             areas.empty() ? kNone : areas[i]});
  for (const weft_region& r : array(request.regions, request.region_count, "domain.regions"))
    pslg.regions.push_back({{r.x, r.y}, r.id, bound(r.bound, at("domain.regions", pslg.regions))});
  for (const weft_area& a : array(request.areas, request.area_count, "domain.areas"))
    pslg.areas.push_back({a.has_region != 0 ? std::optional(a.region) : std::nullopt, a.priority,
                          bound(a.bound, at("domain.areas", pslg.areas)), a.is_hole != 0});
  pslg.fill = enumerator(request.fill, Fill::kUnion, "domain.fill");
  pslg.snap = request.snap;
  return pslg;
}

SizeSpec size(const weft_request& request) {
  SizeSpec spec;
  switch (request.size_kind) {
    case WEFT_SIZE_NONE:
      break;
    case WEFT_SIZE_CONSTANT:
      spec.value = request.size_constant;
      break;
    case WEFT_SIZE_EXPRESSION:
      if (request.size_expression == nullptr) refuse("size.expression", "size.expression is NULL");
      spec.value = std::string(request.size_expression);
      break;
    case WEFT_SIZE_RASTER:
      spec.value = grid(request.size_grid, request.size_values, "size.raster");
      break;
    default:
      enumerator(request.size_kind, WEFT_SIZE_RASTER, "size");
  }
  spec.measure = enumerator(request.size_measure, Measure::kEdge, "size.measure");
  const auto fields = array(request.fields, request.field_count, "size.fields");
  for (std::size_t i = 0; i < fields.size(); ++i)
    spec.fields.push_back(field(fields[i], "size.fields[" + std::to_string(i) + "]"));
  spec.gradation = request.gradation;
  spec.gradation_within = request.gradation_within != 0;
  spec.cells_across = request.cells_across;
  for (const weft_size_at& at : array(request.sizes_at, request.size_at_count, "size.at"))
    spec.at.push_back({at.marker, at.max_edge});
  return spec;
}

}  // namespace

Result<MeshRequest> to_engine(const weft_request& request) try {
  MeshRequest out;
  out.pslg = pslg(request);
  out.size = size(request);
  out.min_angle_deg = request.min_angle_deg;
  out.min_edge = request.min_edge;
  out.placement = enumerator(request.placement, Placement::kCircumcentre, "quality.placement");
  if (request.sweeps >= 0) out.sweeps = static_cast<std::uint32_t>(request.sweeps);
  out.allow_unrefined = request.allow_unrefined != 0;
  out.simplify = request.simplify;
  return out;
} catch (const Failure& failure) {
  return tl::unexpected(failure.error());
}

}  // namespace weft
